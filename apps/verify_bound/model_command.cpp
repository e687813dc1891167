#include "model_command.hpp"

#include <fmt/format.h>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/output_file.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/round_series.hpp>

#include "outcome.hpp"

namespace maximin::verify_bound {

int run_model_command(const Options& options) {
  const Model<double> model = apps::load(options.model);
  const Perturbation<double> perturbation = apps::make_perturbation(model, options.model);
  const std::string source = options.model.file.empty() ? options.model.example : options.model.file;
  const TrialRecord record{0, source, examine(model.mdp, perturbation, examination_options(options))};
  nlohmann::ordered_json how = configuration(options);
  how["model"] = source;
  if (!options.report.empty()) {
    const auto rounds = round_series(model.mdp, perturbation, examination_options(options));
    apps::write_file(options.report, html_report(how, record, rounds), apps::Overwrite::replace);
  }
  if (options.json) {
    nlohmann::ordered_json json{
        {"format", "maximin-verdict"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}, {"configuration", how}};
    json["exit_code"] = exit_code(outcome(record.found));
    json["notes"] = model.notes;
    json["record"] = to_json(record);
    apps::print(apps::json_text(json));
  } else {
    const std::string title = apps::printable(apps::title(model.name, options.model));
    apps::print(verdict_text(title, model, record.found, examination_options(options).reading));
  }
  return exit_code(outcome(record.found));
}

}  // namespace maximin::verify_bound
