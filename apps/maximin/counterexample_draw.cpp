#include <fmt/format.h>
#include <memory>
#include <sstream>
#include <vector>

#include <maximin/apps/common/graphviz_program.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/counterexample.hpp>
#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/graphviz.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin::apps {

namespace {

struct DrawOptions {
  std::string name;
  std::string output = "-";
  bool dot = false;
  bool force = false;
};

/// Each state with V* and what the maximin policy of Q* plays where it is seen; that action is drawn bold.
std::string dot_text(const Counterexample& c) {
  const Model<Rational> model = c.model();
  const auto optimal = policy_iteration(model.mdp);
  GraphvizOptions drawing;
  std::vector<Rational> scratch;
  maximin_policy(optimal.q, make_perturbation(model), drawing.policy, scratch);
  drawing.title = fmt::format("{} (gamma {})\nV*, and what maximin of Q* plays when it sees the state", c.title,
                              exact_text(model.mdp.discount()));
  drawing.action_names = model.action_names;
  for (State s = 0; s < model.mdp.states(); ++s) {
    const Action a = drawing.policy[static_cast<std::size_t>(s)];
    drawing.state_names.push_back(
        fmt::format("{}\nV* = {}\nplays {}", model.state_name(s), exact_text(optimal.v[s]), model.action_name(a)));
  }
  std::ostringstream text;
  write_graphviz(text, model.mdp, drawing);
  return text.str();
}

int draw(const DrawOptions& options) {
  const std::string dot = dot_text(find_counterexample(options.name));
  const std::string drawing = options.dot ? dot : svg_of(dot);
  if (options.output == "-") {
    print(drawing);
    return ExitCode::success;
  }
  write_file(options.output, drawing, options.force ? Overwrite::replace : Overwrite::refuse);
  note(fmt::format("{} written", options.output));
  return ExitCode::success;
}

}  // namespace

void add_counterexample_draw(CLI::App& app, Task& task) {
  auto options = std::make_shared<DrawOptions>();
  auto* sub = app.add_subcommand("draw", "the model as SVG, with V* and the maximin policy, by Graphviz's dot");
  declare_name(*sub, options->name)->required();
  sub->add_option("-o,--output", options->output, "file to write, whole or not at all; - is standard output")
      ->type_name("FILE.svg")
      ->capture_default_str();
  sub->add_flag("--dot", options->dot, "write the text that dot reads instead; dot is then not needed");
  sub->add_flag("--force", options->force, "replace FILE.svg if it exists");
  sub->footer(
      "Examples:\n"
      "  maximin counterexample draw maximin-deadlock -o deadlock.svg\n"
      "  maximin counterexample draw settling --dot | dot -Tpng > settling.png");
  sub->callback([options, &task] { task = [options] { return draw(*options); }; });
}

}  // namespace maximin::apps
