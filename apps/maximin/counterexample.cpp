#include <maximin/apps/maximin/counterexample.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <sstream>
#include <vector>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/make_perturbation.hpp>

namespace maximin::apps {

namespace {

/// "1/2 low, 1/2 high", or "low" when it is certain.
std::string successors_text(const Model<Rational>& model, State s, Action a) {
  const auto row = model.mdp.successors(s, a);
  if (row.size() == 1) return model.state_name(row.front().target);
  std::string text;
  for (const auto& next : row) {
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", exact_text(next.probability), model.state_name(next.target));
  }
  return text;
}

std::string balls_text(const Model<Rational>& model) {
  const auto balls = make_perturbation(model);
  std::string text;
  for (State s = 0; s < balls.states(); ++s) {
    std::string members;
    for (const State t : balls.ball(s)) members += (members.empty() ? "" : ", ") + model.state_name(t);
    text += fmt::format("{}B({}) = {{{}}}", s == 0 ? "" : ", ", model.state_name(s), members);
  }
  return text;
}

}  // namespace

CLI::Option* declare_name(CLI::App& app, std::string& name) {
  std::vector<std::string> names;
  for (const Counterexample& c : counterexamples()) names.emplace_back(c.name);
  return app.add_option("NAME", name, "one of those that list lists")->check(one_of(names))->type_name("");
}

std::string exact_model_text(const Model<Rational>& model) {
  Table table;
  table.column("state", Align::left).column("action", Align::left).column("R").column("leads to", Align::left);
  for (State s = 0; s < model.mdp.states(); ++s) {
    for (Action a = 0; a < model.mdp.actions(); ++a) {
      table.row({model.state_name(s), model.action_name(a), exact_text(model.mdp.reward(s, a)),
                 successors_text(model, s, a)});
    }
  }
  return fmt::format("{} states, {} actions, gamma {}; {}\n\n{}", model.mdp.states(), model.mdp.actions(),
                     exact_text(model.mdp.discount()), balls_text(model), table.text());
}

std::string own_json(const Model<Rational>& model) {
  std::ostringstream text;
  write_maximin_json(model, text);
  return text.str();
}

std::string finding_text(const Counterexample& counterexample, const Counterexample::Finding& finding) {
  std::string text = fmt::format("{}: {}\n", counterexample.name, finding.refuted ? "REFUTED" : "not refuted");
  const auto& [promised, found] = std::pair(finding.promised, finding.found);
  const std::size_t widest = std::max(promised.what.size(), found.what.size());
  text += fmt::format("  claimed  {:<{}}  {}\n", promised.what, widest, exact_text(promised.value));
  text += fmt::format("  found    {:<{}}  {}\n", found.what, widest, exact_text(found.value));
  for (const std::string& line : finding.evidence) text += "  - " + line + "\n";
  return text;
}

void add_counterexample(CLI::App& app, Task& task) {
  auto* sub =
      app.add_subcommand("counterexample", "what is not true: small models with exact checks, drawn, and searched");
  sub->require_subcommand(1);
  add_counterexample_list(*sub, task);
  add_counterexample_show(*sub, task);
  add_counterexample_run(*sub, task);
  add_counterexample_draw(*sub, task);
  add_counterexample_search(*sub, task);
  sub->footer(
      "Examples:\n"
      "  maximin counterexample list\n"
      "  maximin counterexample show sharper-belief\n"
      "  maximin counterexample run --all\n"
      "  maximin counterexample draw settling -o settling.svg\n"
      "  maximin counterexample search sharper-belief");
}

}  // namespace maximin::apps
