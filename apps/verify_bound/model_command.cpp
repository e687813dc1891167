#include "model_command.hpp"

#include <optional>

#include <fmt/format.h>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/round_series.hpp>

#include "outcome.hpp"

namespace maximin::verify_bound {
namespace {

Examination examined(const Model<double>& model, const Options& options) {
  return examine(model.mdp, apps::make_perturbation(model, options.model), examination_options(options));
}

Examination examined(const Model<Rational>& model, const Options& options) {
  apps::StageProgress progress("exact work", options.quiet || options.json);
  ExaminationOptions asked = examination_options(options);
  asked.progress = [&progress](const char* stage, long n) { progress.stage(stage, n); };
  return examine_exactly(model, apps::exact_overrides(options.model), asked);
}

RoundSeries rounds_of(const Model<double>& model, const Options& options) {
  const auto balls = make_perturbation(model, apps::geometry_overrides(options.model));
  return round_series(model.mdp, balls, examination_options(options));
}

RoundSeries rounds_of(const Model<Rational>& model, const Options& options) {
  return rounds_of(rounded(model), options);
}

template <class Scalar>
int run(const Model<Scalar>& model, const Options& options) {
  const std::string source = options.model.file.empty() ? options.model.example : options.model.file;
  std::optional<RoundSeries> rounds;  // first, since they are drawn in floating point, which may not hold the model
  if (!options.report.empty()) rounds = rounds_of(model, options);
  const TrialRecord record{0, source, examined(model, options)};
  const ExaminationOptions asked = examination_options(options);
  nlohmann::ordered_json how = told_configuration(options);
  how["model"] = source;
  if (rounds) write_file(options.report, html_report(how, record, *rounds), Overwrite::replace);
  if (options.json) {
    nlohmann::ordered_json json{
        {"format", "maximin-verdict"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}, {"configuration", how}};
    json["exit_code"] = exit_code(outcome(record.found, asked));
    json["notes"] = model.notes;
    json["record"] = to_json(told(record, asked));
    apps::print(apps::json_text(json));
  } else {
    const std::string title = apps::printable(apps::title(model.name, options.model));
    apps::print(verdict_text(title, model, record.found, asked));
  }
  return exit_code(outcome(record.found, asked));
}

}  // namespace

int run_model_command(const Options& options) {
  return is_exact(options) ? run(apps::load_exactly(options.model), options) : run(apps::load(options.model), options);
}

}  // namespace maximin::verify_bound
