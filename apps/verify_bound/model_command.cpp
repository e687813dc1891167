#include "model_command.hpp"

#include <fmt/format.h>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/output_file.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/round_series.hpp>
#include <maximin/proofs_check/verdict_text.hpp>

namespace maximin::verify_bound {

int run_model_command(const Options& options) {
  const Model<double> model = apps::load(options.model);
  const Perturbation<double> perturbation = apps::make_perturbation(model, options.model);
  const std::string source = options.model.file.empty() ? options.model.example : options.model.file;
  TrialRecord record{0, source, examine(model.mdp, perturbation, examination_options(options))};
  nlohmann::ordered_json how = configuration(options);
  how["model"] = source;
  if (!options.report.empty()) {
    const auto rounds = round_series(model.mdp, perturbation, examination_options(options));
    apps::write_file(options.report, html_report(how, record, rounds), apps::Overwrite::replace);
  }
  if (options.json) {
    nlohmann::ordered_json json{
        {"format", "maximin-verdict"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}, {"configuration", how}};
    json["exit_code"] = static_cast<int>(exit_code(record.found));
    json["notes"] = model.notes;
    json["record"] = to_json(record);
    apps::print(apps::json_text(json));
  } else {
    record.family = apps::printable(source);
    apps::print(verdict_text(record, examination_options(options).reading));
  }
  return static_cast<int>(exit_code(record.found));
}

}  // namespace maximin::verify_bound
