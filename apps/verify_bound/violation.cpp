#include "violation.hpp"

#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include <maximin/apps/common/output_file.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin::verify_bound {
void write_model(const std::filesystem::path& path, const Model<double>& model) {
  std::ostringstream text;
  write_maximin_json(model, text);
  apps::write_file(path, text.str(), apps::Overwrite::replace);
}

void save_violation(const Options& options, Model<double> model, long trial, ClaimId id) {
  ExaminationOptions only = examination_options(options);
  only.only = {id};
  const auto still_violates = [&](const Model<double>& candidate) {
    try {
      return examine(candidate.mdp, make_perturbation(candidate), only).check(id).verdict == Verdict::violated;
    } catch (const std::runtime_error&) {
      return false;  // a step of the shrinking left no valid model, or one that is too hard to decide
    }
  };
  if (!still_violates(model)) {
    throw InputError(
        fmt::format("trial {}: its record says that {} is violated, but its model does not violate it; expected "
                    "a trials file that nobody has edited",
                    trial, claim(id).name));
  }
  const State states = model.mdp.states();
  model = shrink(std::move(model), still_violates);
  model.name = fmt::format("violates {} (seed {}, trial {})", claim(id).name, options.seed, trial);
  const std::filesystem::path path = (std::filesystem::path(options.violation_dir) /
                                      fmt::format("violation-{}-{}-{}.json", options.seed, trial, claim(id).name))
                                         .lexically_normal();
  write_model(path, model);
  const std::string reading = options.reading == "corrected" ? "" : " --reading " + options.reading;
  fmt::print(stderr, "A model that violates {}, shrunk from {} to {} states: {}\nSee it: verify_bound --model {}{}\n",
             claim(id).name, states, model.mdp.states(), path.string(), path.string(), reading);
}

}  // namespace maximin::verify_bound
