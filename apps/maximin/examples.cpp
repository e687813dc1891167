#include <fmt/format.h>
#include <memory>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/models/builtin_models.hpp>

namespace maximin::apps {

namespace {

std::string examples_text() {
  Table table;
  table.column("name", Align::left).column("states").column("actions").column("gamma", Align::point);
  table.column("what it shows", Align::left);
  for (const std::string& name : builtin_model_names()) {
    const Model<double> model = builtin_model(name);
    table.row({name, std::to_string(model.mdp.states()), std::to_string(model.mdp.actions()),
               number(model.mdp.discount()), std::string(builtin_model_summary(name))});
  }
  return table.text();
}

Json examples_json() {
  Json json;
  json["command"] = "examples";
  json["version"] = MAXIMIN_VERSION;
  Json list = Json::array();
  for (const std::string& name : builtin_model_names()) {
    const Model<double> model = builtin_model(name);
    Json one;
    one["name"] = name;
    one["states"] = model.mdp.states();
    one["actions"] = model.mdp.actions();
    one["discount"] = model.mdp.discount();
    one["summary"] = builtin_model_summary(name);
    list.push_back(std::move(one));
  }
  json["examples"] = std::move(list);
  return json;
}

}  // namespace

void add_examples(CLI::App& app, Task& task) {
  auto json = std::make_shared<bool>(false);
  auto* sub = app.add_subcommand("examples", "the built-in models, for --example NAME of every other command");
  sub->add_flag("--json", *json, "print one JSON object on standard output, and nothing else there");
  sub->footer("Example:\n  maximin solve --example cycling --robust");
  sub->callback([json, &task] {
    task = [json] {
      print(*json ? json_text(examples_json()) : examples_text());
      return ExitCode::success;
    };
  });
}

}  // namespace maximin::apps
