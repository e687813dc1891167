#include <maximin/deep/report/json_fields.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <maximin/models/files/input_file.hpp>
#include <maximin/models/files/json_text.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

using Json = nlohmann::ordered_json;

/// A device has no end; a table of results is a hundredth of it.
constexpr std::size_t most_bytes = std::size_t{1} << 28U;

/// What was read from text is unsigned where it can be; what a program put there may be signed.
bool is_whole(const Json& json) {
  return json.is_number_unsigned() || (json.is_number_integer() && json.get<std::int64_t>() >= 0);
}

std::string on_one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool holds_objects(const Json& json) {
  if (json.is_object()) return true;
  if (!json.is_array()) return false;
  return std::any_of(json.begin(), json.end(), [](const Json& x) { return holds_objects(x); });
}

void write_readable(const Json& json, std::size_t depth, std::string& text) {
  if (json.empty() || !holds_objects(json)) {
    text += on_one_line(json);
    return;
  }
  const std::string line = '\n' + std::string(depth + 1, ' ');
  text += json.is_object() ? '{' : '[';
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    text += first ? line : ',' + line;
    first = false;
    if (json.is_object()) text += on_one_line(key) + ": ";
    write_readable(value, depth + 1, text);
  }
  text += '\n' + std::string(depth, ' ') + (json.is_object() ? '}' : ']');
}

}  // namespace

Fields::Fields(const Json& json, std::string where, std::string path)
    : json_(&json), where_(std::move(where)), path_(std::move(path)) {
  if (!json.is_object()) {
    throw InputError(
        fmt::format("{}: {}{}, expected an object", where_, path_.empty() ? "" : path_ + ": ", excerpt(json)));
  }
}

void Fields::refuse(std::string_view key, std::string_view what) const {
  throw InputError(fmt::format("{}: {}{}{}: {}", where_, path_, path_.empty() ? "" : ".", key, what));
}

bool Fields::has(std::string_view key) const {
  return json_->contains(std::string(key));
}

const Json& Fields::any(std::string_view key) const {
  const auto it = json_->find(std::string(key));
  if (it == json_->end()) refuse(key, "not there, expected a value");
  return *it;
}

std::string Fields::text(std::string_view key) const {
  const Json& v = any(key);
  if (!v.is_string()) refuse(key, excerpt(v) + ", expected a text");
  return v.get<std::string>();
}

double Fields::number(std::string_view key) const {
  const Json& v = any(key);
  if (!v.is_number() || !std::isfinite(v.get<double>())) refuse(key, excerpt(v) + ", expected a finite number");
  return v.get<double>();
}

std::uint64_t Fields::whole(std::string_view key) const {
  const Json& v = any(key);
  if (!is_whole(v)) refuse(key, excerpt(v) + ", expected a whole number >= 0");
  return v.get<std::uint64_t>();
}

bool Fields::flag(std::string_view key) const {
  const Json& v = any(key);
  if (!v.is_boolean()) refuse(key, excerpt(v) + ", expected true or false");
  return v.get<bool>();
}

std::vector<double> Fields::numbers(std::string_view key) const {
  const Json& v = any(key);
  if (!v.is_array()) refuse(key, excerpt(v) + ", expected a list of numbers");
  std::vector<double> all;
  for (const Json& x : v) {
    if (!x.is_number() || !std::isfinite(x.get<double>())) {
      refuse(fmt::format("{}[{}]", key, all.size()), excerpt(x) + ", expected a finite number");
    }
    all.push_back(x.get<double>());
  }
  return all;
}

Fields Fields::object(std::string_view key) const {
  return Fields(any(key), where_, fmt::format("{}{}{}", path_, path_.empty() ? "" : ".", key));
}

std::vector<Fields> Fields::objects(std::string_view key) const {
  const Json& v = any(key);
  if (!v.is_array()) refuse(key, excerpt(v) + ", expected a list");
  std::vector<Fields> all;
  for (const Json& x : v) {
    all.emplace_back(x, where_, fmt::format("{}{}{}[{}]", path_, path_.empty() ? "" : ".", key, all.size()));
  }
  return all;
}

std::vector<std::vector<double>> Fields::tuples(std::string_view key, std::size_t length) const {
  const Json& v = any(key);
  if (!v.is_array()) refuse(key, excerpt(v) + ", expected a list");
  std::vector<std::vector<double>> all;
  for (const Json& row : v) {
    bool good = row.is_array() && row.size() == length;
    for (std::size_t i = 0; good && i < length; ++i) good = row[i].is_number() && std::isfinite(row[i].get<double>());
    if (!good) {
      refuse(fmt::format("{}[{}]", key, all.size()), fmt::format("{}, expected {} numbers", excerpt(row), length));
    }
    all.push_back(row.get<std::vector<double>>());
  }
  return all;
}

void Fields::expect_schema(std::string_view schema, std::uint64_t version) const {
  const std::string expected = fmt::format(", expected \"{}\" version {}", schema, version);
  const auto it = json_->find("schema");
  if (it == json_->end()) refuse("schema", "not there" + expected);
  if (!it->is_string() || it->get<std::string>() != schema) refuse("schema", excerpt(*it) + expected);
  const Json& found = any("schema_version");
  if (!is_whole(found) || found.get<std::uint64_t>() != version) {
    refuse("schema_version", excerpt(found) + expected);
  }
}

Json read_json_file(const std::filesystem::path& path, std::string_view expected) {
  return parse_json(file_bytes(path, most_bytes, expected), 64, path.string(), expected);
}

std::string readable_json(const Json& json) {
  std::string text;
  write_readable(json, 0, text);
  return text + '\n';
}

}  // namespace maximin::deep
