#include <fmt/format.h>
#include <memory>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/counterexample.hpp>
#include <maximin/counterexamples/gallery.hpp>

/// list and show.
namespace maximin::apps {

namespace {

/// Lines become one.
std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) c = c == '\n' ? ' ' : c;
  return line;
}

std::string list_text() {
  Table table;
  table.column("name", Align::left).column("states").column("actions").column("what it shows", Align::left);
  for (const Counterexample& c : counterexamples()) {
    const Model<Rational> model = c.model();
    table.row({std::string(c.name), std::to_string(model.mdp.states()), std::to_string(model.mdp.actions()),
               std::string(c.title)});
  }
  return table.text();
}

Json entry_json(const Counterexample& c) {
  const Model<Rational> model = c.model();
  Json json;
  json["name"] = c.name;
  json["title"] = c.title;
  json["states"] = model.mdp.states();
  json["actions"] = model.mdp.actions();
  json["claim"] = one_line(c.claim);
  json["has_search"] = c.searched != nullptr;
  return json;
}

Json list_json() {
  Json json;
  json["command"] = "counterexample list";
  json["version"] = MAXIMIN_VERSION;
  json["counterexamples"] = Json::array();
  for (const Counterexample& c : counterexamples()) json["counterexamples"].push_back(entry_json(c));
  return json;
}

std::string show_text(const Counterexample& c) {
  return fmt::format("{}: {}\n\nClaim, which is false: {}\n\n{}\n{}\n", c.name, c.title, one_line(c.claim),
                     exact_model_text(c.model()), c.explanation);
}

Json show_json(const Counterexample& c) {
  Json json = entry_json(c);
  json["explanation"] = one_line(c.explanation);
  json["model"] = Json::parse(own_json(c.model()));
  Json whole;
  whole["command"] = "counterexample show";
  whole["version"] = MAXIMIN_VERSION;
  for (auto& [key, value] : json.items()) whole[key] = value;
  return whole;
}

struct ShowOptions {
  std::string name;
  bool json = false;
  bool model = false;
};

std::string shown(const ShowOptions& options) {
  const Counterexample& c = find_counterexample(options.name);
  if (options.model) return own_json(c.model());
  return options.json ? json_text(show_json(c)) : show_text(c);
}

}  // namespace

void add_counterexample_list(CLI::App& app, Task& task) {
  auto json = std::make_shared<bool>(false);
  auto* sub = app.add_subcommand("list", "the counterexamples, a line each");
  sub->add_flag("--json", *json, "print one JSON object on standard output, and nothing else there");
  sub->callback([json, &task] {
    task = [json] {
      print(*json ? json_text(list_json()) : list_text());
      return ExitCode::success;
    };
  });
}

void add_counterexample_show(CLI::App& app, Task& task) {
  auto options = std::make_shared<ShowOptions>();
  auto* sub = app.add_subcommand("show", "the model, the claim and why it is false");
  declare_name(*sub, options->name)->required();
  auto* json =
      sub->add_flag("--json", options->json, "print one JSON object on standard output, and nothing else there");
  sub->add_flag("--model", options->model, "print the model in the project's own JSON, for the other commands")
      ->excludes(json);
  sub->footer(
      "Examples:\n"
      "  maximin counterexample show sharper-belief\n"
      "  maximin counterexample show settling --model > m.json && maximin solve m.json --robust");
  sub->callback([options, &task] {
    task = [options] {
      print(shown(*options));
      return ExitCode::success;
    };
  });
}

}  // namespace maximin::apps
