#include <maximin/proofs_check/trial_record.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<Verdict, std::string_view>, 5> verdicts{{{Verdict::holds, "holds"},
                                                                        {Verdict::violated, "violated"},
                                                                        {Verdict::undetermined, "undetermined"},
                                                                        {Verdict::assumption_fails, "assumption fails"},
                                                                        {Verdict::not_asked, "not asked"}}};

constexpr std::array<std::pair<Fate, std::string_view>, 3> fates{
    {{Fate::settled, "settled"}, {Fate::cycles, "cycles"}, {Fate::undetermined, "undetermined"}}};

template <class Table>
auto value_named(const Table& table, const std::string& name) {
  for (const auto& [value, text] : table) {
    if (text == name) return value;
  }
  throw InputError("'" + name + "' is not a known verdict or fate");
}

/// A number, or NaN for null.
double number(const Json& json) {
  if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!json.is_number()) throw InputError("a number is missing");
  return json.get<double>();
}

/// A field of exactly the wanted kind and range: what is edited by hand must not slip through a conversion.
template <class T>
T field_of(const Json& json, const char* name) {
  const Json& value = json.at(name);
  if constexpr (std::is_same_v<T, bool>) {
    if (value.is_boolean()) return value.get<bool>();
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (value.is_string()) return value.get<std::string>();
  } else if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    if (number >= -1 && number <= static_cast<std::int64_t>(std::numeric_limits<T>::max()))
      return static_cast<T>(number);
  }
  throw InputError(std::string(name) + ": not of its kind or out of range");
}

/// JSON knows no infinity; null reads back as NaN, so both must print alike.
Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json check_to_json(const Check& check) {
  return {{"verdict", to_string(check.verdict)},
          {"left", number(check.left)},
          {"right", number(check.right)},
          {"slack", number(check.slack)},
          {"n", check.n},
          {"state", check.place.state},
          {"other_state", check.place.other},
          {"action", check.place.action},
          {"least_right", number(check.least_right)},
          {"instances", check.instances}};
}

Check check_from_json(const Json& json) {
  Check check;
  check.verdict = value_named(verdicts, field_of<std::string>(json, "verdict"));
  check.left = number(json.at("left"));
  check.right = number(json.at("right"));
  check.slack = number(json.at("slack"));
  check.n = field_of<long>(json, "n");
  check.place = {field_of<State>(json, "state"), field_of<State>(json, "other_state"),
                 field_of<Action>(json, "action")};
  check.least_right = number(json.at("least_right"));
  check.instances = field_of<long>(json, "instances");
  return check;
}

/// The plain fields of an examination, listed once for both directions: visit(name, field).
template <class E, class Visit>
void for_each_field(E& e, Visit visit) {
  visit("states", e.states);
  visit("actions", e.actions);
  visit("discount", e.discount);
  visit("eps", e.eps);
  visit("radius", e.radius);
  visit("l_r", e.constants.l_r.value);
  visit("l_p", e.constants.l_p.value);
  visit("k_tv", e.constants.k_tv.value);
  visit("r_min", e.constants.r_min);
  visit("r_max_signed", e.constants.r_max_signed);
  visit("r_max", e.constants.r_max);
  visit("span", e.constants.span);
  visit("l_star", e.lipschitz_of_q_star);
  visit("trivial", e.trivial);
  visit("period", e.period);
  visit("periodic_from", e.periodic_from);
  visit("iterations", e.iterations);
  visit("pairs", e.pairs);
  visit("largest_ball", e.largest_ball);
  visit("attack_changes_action", e.attack_changes_action);
  visit("pessimism_changes_action", e.pessimism_changes_action);
  visit("gap", e.gap);
  visit("belief_positions", e.belief_positions);
  visit("failed_assumption", e.failed_assumption);
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  for (const auto& [value, text] : verdicts) {
    if (value == verdict) return text;
  }
  return "?";
}

std::string_view to_string(Fate fate) {
  for (const auto& [value, text] : fates) {
    if (value == fate) return text;
  }
  return "?";
}

std::string_view to_string(Reading reading) {
  return reading == Reading::paper ? "paper" : "corrected";
}

Json to_json(const TrialRecord& record) {
  Json json{{"trial", record.trial}, {"family", record.family}};
  if (record.score) json["score"] = number(*record.score);
  for_each_field(record.found, [&]<class T>(const char* name, const T& field) {
    if constexpr (std::is_same_v<T, double>) {
      json[name] = number(field);
    } else {
      json[name] = field;
    }
  });
  json["fate"] = to_string(record.found.fate);
  Json& checks = json["claims"] = Json::object();
  for (const Claim& c : claims()) {
    const Check& check = record.found.check(c.id);
    if (check.verdict != Verdict::not_asked) checks[std::string(c.name)] = check_to_json(check);
  }
  return json;
}

TrialRecord trial_record_from_json(const Json& json) {
  TrialRecord record;
  record.trial = field_of<long>(json, "trial");
  record.family = field_of<std::string>(json, "family");
  if (json.contains("score")) record.score = number(json["score"]);
  for_each_field(record.found, [&]<class T>(const char* name, T& field) {
    if constexpr (std::is_same_v<T, double>) {
      field = number(json.at(name));
    } else {
      field = field_of<T>(json, name);
    }
  });
  record.found.fate = value_named(fates, field_of<std::string>(json, "fate"));
  for (const auto& [name, check] : json.at("claims").items()) {
    const auto id = find_claim(name);
    if (!id) throw InputError("'" + name + "' is not a claim");
    record.found.check(*id) = check_from_json(check);
  }
  return record;
}

}  // namespace maximin
