#include "strict_json.hpp"

#include <algorithm>
#include <set>

namespace maximin::checker {
namespace {

using nlohmann::json;

constexpr std::size_t deepest = 8;  // a certificate has 5 levels

/// Follows the parser, so that what a tree of JSON cannot tell is refused: names that occur twice, depth, fractions.
class Watcher {
 public:
  bool operator()(int, json::parse_event_t event, const json& value) {
    using Event = json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        next();
        open_.push_back({event == Event::array_start, 0, {}, {}});
        if (open_.size() > deepest) refuse(path(), "too deep, expected at most 8 levels");
        break;
      case Event::object_end:
      case Event::array_end:
        open_.pop_back();
        break;
      case Event::key:
        open_.back().name = value.get_ref<const std::string&>();
        if (!open_.back().names.insert(open_.back().name).second) refuse(path(), "given twice, expected once");
        break;
      case Event::value:
        next();
        if (value.is_number_float()) refuse(path(), "neither an integer nor a string, expected exact numbers alone");
        break;
    }
    return true;
  }

 private:
  struct Open {
    bool array;
    std::size_t items;
    std::string name;  // the last one read
    std::set<std::string> names;
  };

  void next() {
    if (!open_.empty() && open_.back().array) ++open_.back().items;
  }

  std::string path() const {
    std::string text = "$";
    for (const Open& open : open_) {
      if (open.array && open.items > 0) text = item(text, open.items - 1);
      if (!open.array && !open.name.empty()) text += "." + open.name;
    }
    return text;
  }

  std::vector<Open> open_;
};

/// The start of a text from the file, for a message.
std::string quoted(const std::string& text) {
  return "\"" + text.substr(0, 40) + (text.size() > 40 ? "...\"" : "\"");
}

std::string describe(const json& value) {
  if (value.is_string()) return quoted(value.get_ref<const std::string&>());
  if (value.is_structured()) return std::string("an ") + value.type_name();
  return value.dump();
}

}  // namespace

void refuse(const std::string& path, const std::string& what_and_expected) {
  std::string line = path + ": " + what_and_expected;
  // What the file says must neither break the line nor drive a terminal.
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(line.begin(), line.end(), control, '?');
  throw Refused(line);
}

std::string item(const std::string& path, std::size_t i) {
  return path + "[" + std::to_string(i) + "]";
}

void expect_equal(const std::string& path, const Rational& found, const Rational& expected) {
  if (found != expected) refuse(path, shown(found) + ", expected " + shown(expected));
}

void expect_equal(const std::string& path, const std::vector<std::size_t>& found,
                  const std::vector<std::size_t>& expected, const std::string& of_what) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (found[i] != expected[i])
      refuse(item(path, i), std::to_string(found[i]) + ", expected " + std::to_string(expected[i]) + of_what);
  }
}

json parse_json(std::string_view text, const Limits& limits) {
  if (text.size() > limits.bytes) {
    refuse("$", std::to_string(text.size()) + " bytes, expected at most " + std::to_string(limits.bytes));
  }
  // JSON has neither; the parser would skip the one, and take the other for the end of the text.
  if (text.starts_with("\xef\xbb\xbf")) refuse("$", "a byte-order mark, expected one JSON object in UTF-8");
  if (const std::size_t nul = text.find('\0'); nul != text.npos) {
    refuse("$", "no JSON at byte " + std::to_string(nul + 1) + ", expected one JSON object in UTF-8");
  }
  try {
    Watcher watcher;
    return json::parse(text, [&watcher](int depth, json::parse_event_t event, const json& value) {
      return watcher(depth, event, value);
    });
  } catch (const json::parse_error& error) {
    refuse("$", "no JSON at byte " + std::to_string(error.byte) + ", expected one JSON object in UTF-8");
  } catch (const json::exception&) {
    refuse("$", "no JSON, expected one JSON object in UTF-8");  // e.g. an integer beyond all types
  }
}

void Node::expect_members(const std::vector<const char*>& names) const {
  if (!json_.is_object()) refuse(path_, describe(json_) + ", expected an object");
  for (const char* name : names) {
    if (!json_.contains(name)) refuse(path_ + "." + name, "missing, expected it here");
  }
  for (const auto& member : json_.items()) {
    if (std::find(names.begin(), names.end(), member.key()) == names.end()) {
      refuse(path_, quoted(member.key()) + " is no member of it, expected none but those of the format");
    }
  }
}

std::vector<Node> Node::items() const {
  if (!json_.is_array()) refuse(path_, describe(json_) + ", expected an array");
  std::vector<Node> nodes;
  nodes.reserve(json_.size());
  for (const json& value : json_) nodes.emplace_back(value, item(path_, nodes.size()), limits_);
  return nodes;
}

std::vector<Node> Node::items(std::size_t length) const {
  if (!json_.is_array()) refuse(path_, describe(json_) + ", expected an array");
  if (json_.size() != length) {
    refuse(path_, std::to_string(json_.size()) + " items, expected " + std::to_string(length));
  }
  return items();
}

std::size_t Node::integer(std::size_t low, std::size_t high) const {
  if (json_.is_number_unsigned()) {
    const auto value = json_.get<std::size_t>();
    if (low <= value && value <= high) return value;
  }
  refuse(path_, describe(json_) + ", expected an integer from " + std::to_string(low) + " to " + std::to_string(high));
}

std::vector<std::size_t> Node::indices(std::size_t length, std::size_t end) const {
  std::vector<std::size_t> result;
  for (const Node& node : items(length)) result.push_back(node.index(end));
  return result;
}

bool Node::boolean() const {
  if (!json_.is_boolean()) refuse(path_, describe(json_) + ", expected true or false");
  return json_.get<bool>();
}

Rational Node::number() const {
  if (json_.is_string()) {
    const auto& text = json_.get_ref<const std::string&>();
    if (text.size() > limits_.digits) {
      refuse(path_, std::to_string(text.size()) + " characters, expected at most " + std::to_string(limits_.digits));
    }
    if (const auto value = parse_number(text)) return *value;
  }
  refuse(path_, describe(json_) + ", expected an integer or a fraction in lowest terms, as a string");
}

Table Node::table(std::size_t length) const {
  std::vector<Rational> numbers;
  for (const Node& node : items(length)) numbers.push_back(node.number());
  return table_of(numbers);
}

Table Node::table_of(const std::vector<Rational>& numbers) const {
  auto table = over_one_denominator(numbers, limits_.table_bits);
  if (!table) refuse(path_, "numbers that take too much memory, expected smaller denominators");
  return *std::move(table);
}

std::size_t Node::one_of(std::initializer_list<const char*> texts) const {
  std::string expected;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (json_.is_string() && json_.get_ref<const std::string&>() == texts.begin()[i]) return i;
    expected += (i == 0 ? "\"" : " or \"") + std::string(texts.begin()[i]) + "\"";
  }
  refuse(path_, describe(json_) + ", expected " + expected);
}

}  // namespace maximin::checker
