#include <maximin/apps/maximin/describe.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <charconv>

#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

std::string metric_text(const Problem& problem) {
  using Kind = Geometry<double>::Kind;
  const auto& metric = problem.perturbation.metric();
  switch (problem.metric) {
    case Kind::points:
      return fmt::format("points in R^{} under {}", metric.points()->cols(), norm_name(metric.norm()));
    case Kind::distances:
      return "the model's distances";
    case Kind::neighbourhoods:
      return "the model's neighbourhoods";
    case Kind::discrete:
      return "discrete metric";
    case Kind::none:
    case Kind::hops:
      break;
  }
  return "hops in the transition graph";
}

/// The index of `text` in the names, else as a number below `count`; -1 if it is neither. Throws InputError when it is
/// the name of one and the number of another.
std::int32_t find(const std::vector<std::string>& names, std::int32_t count, const std::string& text,
                  const std::string& option, const char* what) {
  std::int32_t number = -1;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  const std::int32_t index = error == std::errc() && stop == end && number >= 0 && number < count ? number : -1;
  const auto named = std::find(names.begin(), names.end(), text);
  if (named == names.end()) return index;
  const auto name = static_cast<std::int32_t>(named - names.begin());
  if (index < 0 || index == name) return name;
  throw InputError(fmt::format("{}: {} is the name of {} {} and the index of another, expected a word that is one {}",
                               option, text, what, name, what));
}

[[noreturn]] void fail_to_find(const std::string& option, const std::string& text, const std::string& what,
                               std::int32_t count, const std::vector<std::string>& names) {
  const std::string near = nearest_name(text, names);
  throw InputError(fmt::format("{}: {} is no {}, expected {}0 to {}{}", option, text, what,
                               names.empty() ? "" : "a name or an index ", count - 1,
                               near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace

void declare(CLI::App& app, OutputOptions& options) {
  app.add_flag("--json", options.json, "print one JSON object on standard output, and nothing else there")
      ->disable_flag_override();
  app.add_flag("--all", options.all, "print every row of the tables, however many")->disable_flag_override();
}

std::string model_line(const Model<double>& model, const std::string& title) {
  const auto& mdp = model.mdp;
  return fmt::format("{}: {} states, {} actions, {} transitions, gamma {}\n", printable(title), mdp.states(),
                     mdp.actions(), mdp.transition_count(), number(mdp.discount()));
}

std::string model_line(const Problem& problem) {
  return model_line(problem.model, problem.title);
}

Json model_json(const Model<double>& model) {
  Json json;
  json["name"] = model.name;
  json["states"] = model.mdp.states();
  json["actions"] = model.mdp.actions();
  json["transitions"] = model.mdp.transition_count();
  json["discount"] = model.mdp.discount();
  json["state_names"] = model.state_names;
  json["action_names"] = model.action_names;
  json["notes"] = model.notes;
  return json;
}

Problem load_problem(const ModelOptions& options) {
  Model<double> model = load(options);
  const auto kind = resolve_geometry(model, geometry_overrides(options)).kind;
  Perturbation<double> perturbation = make_perturbation(model, options);
  std::string name = title(model.name, options);
  return {std::move(model), std::move(name), kind, std::move(perturbation)};
}

std::string balls_line(const Problem& problem) {
  const auto& perturbation = problem.perturbation;
  const auto largest = static_cast<std::size_t>(perturbation.largest_ball());
  std::size_t smallest = largest;
  for (State s = 0; s < perturbation.states(); ++s) smallest = std::min(smallest, perturbation.ball(s).size());
  return fmt::format("Balls: {}, eps {}, {}{} state{} each\n", metric_text(problem), number(perturbation.eps()),
                     smallest == largest ? "" : fmt::format("{} to ", smallest), largest, largest == 1 ? "" : "s");
}

Json balls_json(const Problem& problem) {
  Json json;
  json["metric"] = metric_text(problem);
  json["eps"] = problem.perturbation.eps();
  json["radius"] = problem.perturbation.radius();
  Json sizes = Json::array();
  for (State s = 0; s < problem.perturbation.states(); ++s) sizes.push_back(problem.perturbation.ball(s).size());
  json["sizes"] = std::move(sizes);
  return json;
}

double start_mean(const Model<double>& model, const Values<double>& v) {
  if (model.start.empty()) return v.mean();
  double mean = 0;
  for (Eigen::Index s = 0; s < v.size(); ++s) mean += model.start[static_cast<std::size_t>(s)] * v[s];
  return mean;
}

std::string set_text(const Model<double>& model, std::span<const State> states, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, states.size()); ++i) {
    text += (i == 0 ? "" : ", ") + printable(model.state_name(states[i]));
  }
  if (states.size() > most) text += fmt::format(", and {} more", states.size() - most);
  return "{" + text + "}";
}

Json action_names(const Model<double>& model, const Policy& policy) {
  Json names = Json::array();
  for (const Action a : policy) names.push_back(model.action_name(a));
  return names;
}

State find_state(const Model<double>& model, const std::string& text, const std::string& option) {
  const State s = find(model.state_names, model.mdp.states(), text, option, "state");
  if (s < 0) fail_to_find(option, text, "state", model.mdp.states(), model.state_names);
  return s;
}

Action find_action(const Model<double>& model, const std::string& text, const std::string& option) {
  const Action a = find(model.action_names, model.mdp.actions(), text, option, "action");
  if (a < 0) fail_to_find(option, text, "action", model.mdp.actions(), model.action_names);
  return a;
}

}  // namespace maximin::apps
