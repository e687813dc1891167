#include <maximin/models/files/json_text.hpp>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {

using Json = nlohmann::ordered_json;

Json parse_json(std::string_view text, int most_levels, const std::string& where, std::string_view expected) {
  const auto shallow = [&](int depth, Json::parse_event_t, Json&) {
    if (depth <= most_levels) return true;
    throw InputError(fmt::format("{}: nested deeper than {} levels, expected {}", where, most_levels, expected));
  };
  Json json = Json::parse(text, shallow, false);
  if (json.is_discarded()) throw InputError(fmt::format("{}: not JSON, expected {}", where, expected));
  return json;
}

std::string excerpt(const Json& value) {
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

std::string first_difference(const Json& there, const Json& now) {
  if (!there.is_object() || !now.is_object()) return "other settings";
  for (const auto& [key, value] : now.items()) {
    if (!there.contains(key)) return fmt::format("it has no {}", key);
    if (there[key] == value) continue;
    if (value.is_object() && there[key].is_object()) return first_difference(there[key], value);
    return fmt::format("{} is {} there and {} now", key, there[key].dump(), value.dump());
  }
  return "it has more settings";
}

}  // namespace maximin
