#include "violation.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin::verify_bound {
namespace {

std::string file_text(const Model<double>& model) {
  std::ostringstream text;
  write_maximin_json(model, text);
  return text.str();
}

bool holds_text(const std::filesystem::path& path, const std::string& text) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {}) == text;
}

/// STEM.json, or STEM-2.json and so on: the first name that is free or that holds this text already, so that what
/// another campaign found with the same seed stays.
std::filesystem::path name_for(const std::filesystem::path& stem, const std::string& text) {
  std::filesystem::path path = stem.string() + ".json";
  for (int k = 2; std::filesystem::exists(path) && !holds_text(path, text); ++k) {
    path = fmt::format("{}-{}.json", stem.string(), k);
  }
  return path;
}

}  // namespace

std::string save_under_new_name(const std::filesystem::path& stem, const Model<double>& model) {
  const std::string text = file_text(model);
  const std::filesystem::path path = name_for(stem.lexically_normal(), text);
  write_file(path, text, Overwrite::replace);
  return path.string();
}

void write_model(const std::filesystem::path& path, const Model<double>& model) {
  write_file(path, file_text(model), Overwrite::replace);
}

void save_violation(const Options& options, Model<double> model, long trial, ClaimId id) {
  ExaminationOptions only = examination_options(options);
  only.only = {id};
  const auto still_violates = [&](const Model<double>& candidate) {
    try {
      const Examination found = only.exact ? examine_exactly(rationalise(candidate), {}, only)
                                           : examine(candidate.mdp, make_perturbation(candidate), only);
      return found.check(id).verdict == Verdict::violated;
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
  const std::string name = fmt::format("violation-{}-{}-{}", options.seed, trial, claim(id).name);
  const std::string path = save_under_new_name(std::filesystem::path(options.violation_dir) / name, model);
  const std::string reading = options.reading == "corrected" ? "" : " --reading " + options.reading;
  fmt::print(stderr, "A model that violates {}, shrunk from {} to {} states: {}\nSee it: verify_bound --model {}{}\n",
             claim(id).name, states, model.mdp.states(), path, path, reading);
}

}  // namespace maximin::verify_bound
