#include <maximin/apps/maximin/policy_file.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include <maximin/apps/maximin/describe.hpp>
#include <maximin/models/files/json_text.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

constexpr std::size_t largest_policy_file = std::size_t{64} << 20;
constexpr int deepest_json = 32;  // the JSON of maximin solve has 6 levels

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (std::string_view(", \t\r\n[]\"").find(c) == std::string_view::npos) {
      result.back() += c;
    } else if (!result.back().empty()) {
      result.emplace_back();
    }
  }
  if (result.back().empty()) result.pop_back();
  return result;
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text;
  text.resize(largest_policy_file + 1);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (text.empty() && !in.eof())) throw InputError(path + ": cannot be read, expected a list of actions");
  if (text.size() > largest_policy_file) throw InputError(path + ": larger than 64 MiB, expected a list of actions");
  return text;
}

void check_size(std::size_t size, const Model<double>& model, const std::string& where) {
  if (size == static_cast<std::size_t>(model.mdp.states())) return;
  throw InputError(fmt::format("{}: {} actions, expected {}, one for each state that may be observed", where, size,
                               model.mdp.states()));
}

/// The action of one entry: a whole number is an index and a string is a name.
Action action_of(const nlohmann::ordered_json& entry, const Model<double>& model, const std::string& where) {
  const auto refuse = [&](const std::string& what, const std::string& expected) {
    throw InputError(fmt::format("{}: {}, expected {}", where, what, expected));
  };
  const Action actions = model.mdp.actions();
  if (entry.is_number_integer()) {
    const bool inside = entry.is_number_unsigned() && entry.get<std::uint64_t>() < static_cast<std::uint64_t>(actions);
    if (!inside) refuse(entry.dump() + " is no action", fmt::format("an index 0 to {}", actions - 1));
    return entry.get<Action>();
  }
  if (!entry.is_string())
    refuse(entry.is_number() ? entry.dump() : std::string("a value of type ") + entry.type_name(),
           "the index or name of an action");
  const auto name = entry.get<std::string>();
  if (model.action_names.empty()) return find_action(model, name, where);
  const auto found = std::find(model.action_names.begin(), model.action_names.end(), name);
  if (found == model.action_names.end()) refuse('"' + name + "\" is no action", "the name of one");
  return static_cast<Action>(found - model.action_names.begin());
}

Policy policy_of_json(const nlohmann::ordered_json& json, const Model<double>& model, const std::string& path) {
  const bool bare = json.is_array();
  const nlohmann::ordered_json* list = &json;
  if (!bare) {
    const auto member = json.find("policy");
    if (member == json.end() || !member->is_array())
      throw InputError(path + ": $.policy: missing, expected a list of actions");
    list = &*member;
  }
  const std::string where = path + (bare ? ": $" : ": $.policy");
  check_size(list->size(), model, where);
  Policy policy;
  for (std::size_t i = 0; i < list->size(); ++i)
    policy.push_back(action_of((*list)[i], model, fmt::format("{}[{}]", where, i)));
  return policy;
}

}  // namespace

Policy policy_of_list(const std::string& list, const Model<double>& model, const std::string& where) {
  const auto actions = words(list);
  check_size(actions.size(), model, where);
  Policy policy;
  for (const std::string& word : actions) policy.push_back(find_action(model, word, where));
  return policy;
}

Policy read_policy_file(const std::string& path, const Model<double>& model) {
  const std::string text = read_text(path);
  const auto first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string::npos && (text[first] == '{' || text[first] == '[');
  return is_json
             ? policy_of_json(parse_json(text, deepest_json, path, "a list of actions or an object with \"policy\""),
                              model, path)
             : policy_of_list(text, model, path);
}

}  // namespace maximin::apps
