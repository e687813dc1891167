#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/nearest_name.hpp>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace maximin::internal {

using JsonKind = JsonValue::Kind;

/// Fills a document from the events of nlohmann's parser.
class JsonDocument::Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(JsonDocument& document, std::string_view text) : document_(document), text_(text) {}

  bool null() override { return leaf(JsonKind::null, "null"); }
  bool boolean(bool value) override { return leaf(JsonKind::boolean, value ? "true" : "false"); }
  bool number_integer(number_integer_t value) override { return leaf(JsonKind::number, std::to_string(value)); }
  bool number_unsigned(number_unsigned_t value) override { return leaf(JsonKind::number, std::to_string(value)); }
  bool number_float(number_float_t, const string_t& text) override { return leaf(JsonKind::number, text); }
  bool string(string_t& value) override { return leaf(JsonKind::string, value); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonKind::object); }
  bool start_array(std::size_t) override { return open(JsonKind::array); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_begin_ = document_.texts_.size();
    key_length_ = static_cast<std::uint32_t>(name.size());
    document_.texts_ += name;
    return true;
  }

  bool end_object() override {
    refuse_repeated_keys();
    return close();
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // "[json.exception...] parse error at line 1, column 2: WHAT": the place is ours to say.
    std::string what = error.what();
    if (const auto prefix = what.find("] "); prefix != std::string::npos) what.erase(0, prefix + 2);
    if (what.starts_with("parse error at line")) what.erase(0, what.find(": ") + 2);
    constexpr int out_of_range = 406;
    if (what.find("expected") == std::string::npos) {
      what +=
          error.id == out_of_range ? ", expected a number that a double can hold" : ", expected JSON as in RFC 8259";
    }
    for (char& c : what) {
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F) c = '?';
    }
    const std::string_view before = text_.substr(0, std::min(position, text_.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    throw InputError(fmt::format("{}:{}: not JSON: {}", document_.file(), line, what));
  }

 private:
  std::uint32_t add(JsonKind kind) {
    // Indices are 32 bits; the limit on a file's bytes keeps them far below.
    if (document_.nodes_.size() >= std::numeric_limits<std::uint32_t>::max() / 2) {
      throw InputError(document_.file() + ": too many values, expected at most 2147483647");
    }
    const auto index = static_cast<std::uint32_t>(document_.nodes_.size());
    Node node;
    node.kind = kind;
    node.parent = open_.empty() ? 0 : open_.back();
    node.end = index + 1;
    node.key_begin = key_begin_;
    node.key_length = key_length_;
    key_length_ = 0;
    document_.nodes_.push_back(node);
    if (!open_.empty()) ++document_.nodes_[open_.back()].size;
    return index;
  }

  bool leaf(JsonKind kind, std::string_view text) {
    Node& node = document_.nodes_[add(kind)];
    node.text_begin = document_.texts_.size();
    node.text_length = static_cast<std::uint32_t>(text.size());
    document_.texts_ += text;
    return true;
  }

  bool open(JsonKind kind) {
    open_.push_back(add(kind));
    if (open_.size() > max_depth) {
      throw InputError(fmt::format("{}: nested more than {} deep, expected a model", document_.file(), max_depth));
    }
    return true;
  }

  bool close() {
    document_.nodes_[open_.back()].end = static_cast<std::uint32_t>(document_.nodes_.size());
    open_.pop_back();
    return true;
  }

  void refuse_repeated_keys() {
    std::vector<std::pair<std::string_view, std::uint32_t>> keys;
    const auto end = static_cast<std::uint32_t>(document_.nodes_.size());
    for (std::uint32_t i = open_.back() + 1; i < end; i = document_.nodes_[i].end) {
      keys.emplace_back(document_.slice(document_.nodes_[i].key_begin, document_.nodes_[i].key_length), i);
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i) {
      if (keys[i].first == keys[i - 1].first) {
        document_.fail(keys[i].second + std::size_t{1}, "given twice, expected each name once");
      }
    }
  }

  JsonDocument& document_;
  std::string_view text_;
  std::vector<std::uint32_t> open_;
  std::size_t key_begin_ = 0;
  std::uint32_t key_length_ = 0;
};

JsonDocument::JsonDocument(std::string_view text, std::string_view file) : Source(file) {
  Builder builder(*this, text);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
}

std::string JsonDocument::place(std::size_t at) const {
  return at == 0 ? file() : fmt::format("{}: {}", file(), path(static_cast<std::uint32_t>(at - 1)));
}

std::string JsonDocument::path(std::uint32_t index) const {
  std::string out;
  while (index != 0) {
    const Node& node = nodes_[index];
    const Node& parent = nodes_[node.parent];
    if (parent.kind == JsonKind::object) {
      const std::string_view key = slice(node.key_begin, node.key_length);
      const bool plain = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      });
      out.insert(0, plain && key.size() <= 40 ? fmt::format(".{}", key) : fmt::format("[{}]", in_quotes(key)));
    } else {
      std::size_t place = 0;
      for (std::uint32_t i = node.parent + 1; i != index; i = nodes_[i].end) ++place;
      out.insert(0, fmt::format("[{}]", place));
    }
    index = node.parent;
  }
  return "$" + out;
}

JsonValue::Iterator& JsonValue::Iterator::operator++() {
  index_ = document_->nodes_[index_].end;
  return *this;
}

JsonKind JsonValue::kind() const {
  return document_->nodes_[index_].kind;
}

std::string_view JsonValue::text() const {
  const auto& node = document_->nodes_[index_];
  return document_->slice(node.text_begin, node.text_length);
}

std::string_view JsonValue::key() const {
  const auto& node = document_->nodes_[index_];
  return document_->slice(node.key_begin, node.key_length);
}

std::size_t JsonValue::size() const {
  return document_->nodes_[index_].size;
}
JsonValue::Iterator JsonValue::begin() const {
  return {document_, index_ + 1};
}
JsonValue::Iterator JsonValue::end() const {
  return {document_, document_->nodes_[index_].end};
}

std::optional<JsonValue> JsonValue::find(std::string_view name) const {
  for (const JsonValue value : *this) {
    if (value.key() == name) return value;
  }
  return std::nullopt;
}

void JsonValue::fail(std::string_view message) const {
  document_->fail(at(), message);
}

JsonValue JsonValue::array(std::string_view name) const {
  if (kind() != JsonKind::array) fail(fmt::format("not an array, expected {}", name));
  return *this;
}

JsonValue JsonValue::array(std::string_view name, std::size_t wanted) const {
  if (array(name).size() != wanted) fail(fmt::format("length {}, expected {}: {}", size(), wanted, name));
  return *this;
}

JsonValue JsonValue::object(std::string_view name) const {
  if (kind() != JsonKind::object) fail(fmt::format("not an object, expected {}", name));
  return *this;
}

std::string_view JsonValue::string(std::string_view name) const {
  if (kind() != JsonKind::string) fail(fmt::format("not a string, expected {}", name));
  return text();
}

bool JsonValue::boolean(std::string_view name) const {
  if (kind() != JsonKind::boolean) fail(fmt::format("neither true nor false, expected one: {}", name));
  return text() == "true";
}

std::uint64_t JsonValue::count(std::string_view name) const {
  const std::optional<std::uint64_t> value = kind() == JsonKind::number ? parse_count(text()) : std::nullopt;
  if (!value) fail(fmt::format("{}: not a non-negative integer, expected one", name));
  return *value;
}

std::uint32_t JsonValue::index(std::string_view name, std::size_t below) const {
  const std::optional<std::uint64_t> value = kind() == JsonKind::number ? parse_count(text()) : std::nullopt;
  if (!value || *value >= below) {
    const std::string shown = kind() == JsonKind::array || kind() == JsonKind::object ? "" : " " + in_quotes(text());
    fail(fmt::format("{}{}: no such {}, expected an integer from 0 to {}", name, shown, name, below - 1));
  }
  return static_cast<std::uint32_t>(*value);
}

JsonValue JsonValue::member(std::string_view name, std::string_view expected) const {
  const std::optional<JsonValue> value = find(name);
  if (!value) fail(fmt::format("'{}' is missing, expected {}", name, expected));
  return *value;
}

void JsonValue::require_known_members(std::span<const std::string_view> known) const {
  for (const JsonValue value : *this) {
    if (std::find(known.begin(), known.end(), value.key()) != known.end()) continue;
    const std::string near = nearest_name(value.key(), {known.begin(), known.end()});
    value.fail(near.empty() ? fmt::format("unknown name, expected one of {}", fmt::join(known, ", "))
                            : fmt::format("unknown name, expected '{}'?", near));
  }
}

std::string json_string(std::string_view text) {
  return nlohmann::json(text).dump();
}

}  // namespace maximin::internal
