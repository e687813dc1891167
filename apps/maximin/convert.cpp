#include <fmt/format.h>
#include <memory>
#include <sstream>

#include <maximin/apps/common/model_options.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/output_file.hpp>

namespace maximin::apps {

namespace {

struct ConvertOptions {
  ModelOptions model;
  std::string output = "-";
  bool force = false;
};

/// The geometry that the command line asks for becomes the model's own.
void apply_geometry(const ModelOptions& options, Model<double>& model) {
  if (options.metric.empty() && options.norm.empty() && options.eps.empty()) return;
  model.geometry = resolve_geometry(model, geometry_overrides(options));
}

int convert(const ConvertOptions& options) {
  Model<double> model = load(options.model);
  apply_geometry(options.model, model);
  std::ostringstream text;
  write_maximin_json(model, text);
  if (options.output == "-") {
    print(text.str());
    return ExitCode::success;
  }
  write_file(options.output, text.str(), options.force ? Overwrite::replace : Overwrite::refuse);
  note(fmt::format("{} written: {} states, {} actions", options.output, model.mdp.states(), model.mdp.actions()));
  return ExitCode::success;
}

}  // namespace

void add_convert(CLI::App& app, Task& task) {
  auto options = std::make_shared<ConvertOptions>();
  auto* sub = app.add_subcommand("convert", "any model file, or example, to the project's own JSON");
  declare(*sub, options->model);
  sub->add_option("-o,--output", options->output, "file to write, whole or not at all; - is standard output")
      ->type_name("FILE")
      ->capture_default_str();
  sub->add_flag("--force", options->force, "replace FILE if it exists");
  sub->footer(
      "A geometry, norm, eps or discount given here is written into the file.\n"
      "Examples:\n"
      "  maximin convert robot.tra -o robot.json --discount 0.99\n"
      "  maximin convert model.drn --metric hops --eps 2 > model.json");
  sub->callback([options, &task] { task = [options] { return convert(*options); }; });
}

}  // namespace maximin::apps
