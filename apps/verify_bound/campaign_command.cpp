#include "campaign_command.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/campaign.hpp>
#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/round_series.hpp>
#include <maximin/proofs_check/trial_file.hpp>

#include "outcome.hpp"
#include "shared_options.hpp"
#include "violation.hpp"

namespace maximin::verify_bound {
namespace {

using Json = nlohmann::ordered_json;

ModelSource model_source(const Options& options) {
  const Family family = family_named(options.family);
  const FamilyOptions restrictions = family_options(options);
  const bool coarse = is_exact(options);
  return [=](Stream& rng) {
    FamilyMember member = draw_family_member(family, restrictions, rng);
    if (coarse) member.model = coarsen(std::move(member.model));
    return DrawnModel{std::string(family_name(member.family)), std::move(member.model)};
  };
}

Campaign campaign(const Options& options) {
  Campaign c;
  c.seed = options.seed;
  c.trials = options.trials;
  c.threads = threads_for(options.threads);
  c.examination = examination_options(options);
  return c;
}

Json header(const Options& options) {
  return {{"format", "maximin-trials"},
          {"version", 1},
          {"maximin", MAXIMIN_VERSION},
          {"configuration", configuration(options)}};
}

std::optional<TrialFile> trial_file(const Options& options) {
  if (options.trials_out.empty()) {
    if (options.resume) throw InputError("--resume: nothing to resume, expected --trials-out FILE beside it");
    return std::nullopt;
  }
  const Json first_line = header(options);
  return options.resume ? TrialFile::resume(options.trials_out, first_line)
                        : TrialFile::create(options.trials_out, first_line);
}

/// Refuses records that this campaign cannot have written.
void check_finished(const Options& options, const std::vector<TrialRecord>& records) {
  if (static_cast<long>(records.size()) > options.trials) {
    throw InputError(fmt::format("{}: {} records, expected at most --trials {}", options.trials_out, records.size(),
                                 options.trials));
  }
  const ExaminationOptions examination = examination_options(options);
  for (const TrialRecord& record : records) {
    for (const Claim& c : claims()) {
      if (examination.wants(c.id) == (record.found.check(c.id).verdict != Verdict::not_asked)) continue;
      throw InputError(fmt::format("{}:{}: claim {} is {} there, expected the claims of this campaign",
                                   options.trials_out, record.trial + 2, c.name,
                                   examination.wants(c.id) ? "not" : "also"));
    }
  }
}

/// Writes the certificates of an exact campaign, and tells in the end how long they took.
class CertificateFolder {
 public:
  explicit CertificateFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (!folder_.empty()) remove_partial_files();
  }

  void write(long trial, const std::string& json, double seconds) {
    write_file(folder_ / fmt::format("trial-{}.json", trial), json, Overwrite::replace);
    const std::lock_guard lock(mutex_);
    times_.emplace_back(seconds, trial);
  }

  /// Removes what a run that was killed had begun to write.
  void remove_partial_files() const {
    std::vector<std::filesystem::path> partial;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("trial-") && name.ends_with(partial_suffix)) partial.push_back(entry.path());
    }
    std::error_code gone;
    for (const auto& file : partial) std::filesystem::remove(file, gone);
  }

  void tell() {
    if (times_.empty()) return;
    std::sort(times_.begin(), times_.end());
    apps::note(fmt::format("{} certificates in {}: {:.2g} s each at the median, at most {:.3g} s (trial {})",
                           times_.size(), folder_.string(), times_[times_.size() / 2].first, times_.back().first,
                           times_.back().second));
  }

 private:
  std::filesystem::path folder_;
  std::mutex mutex_;
  std::vector<std::pair<double, long>> times_;
};

/// All records of the campaign, those of the file first; fewer than asked for when interrupted.
std::vector<TrialRecord> gather(const Options& options, const ModelSource& source, std::optional<TrialFile>& file) {
  Campaign c = campaign(options);
  c.examination.stop = &apps::stop_on_interrupt();
  std::vector<TrialRecord> records;
  if (file) records = file->finished();
  check_finished(options, records);
  c.first = static_cast<long>(records.size());
  CertificateFolder folder(options.certificates);
  if (!options.certificates.empty()) {
    c.certified = [&](long trial, const std::string& json, double seconds) { folder.write(trial, json, seconds); };
  }
  long violations =
      std::count_if(records.begin(), records.end(), [](const auto& r) { return r.found.any(Verdict::violated); });
  apps::Progress progress("models", c.trials, c.first, options.quiet || options.json);
  run_campaign(
      c, source,
      [&](TrialRecord&& record) {
        if (file) file->append(record);
        violations += record.found.any(Verdict::violated);
        records.push_back(std::move(record));
        progress.advance(fmt::format("{} violations", violations));
      },
      apps::stop_on_interrupt());
  folder.tell();
  return records;
}

/// A report that cannot be written should be known before a long run and not after it.
void check_folder_of(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(fmt::format("{}: no such folder, expected one that exists", folder.string()));
  }
}

Json summary_json(const Options& options, const CampaignSummary& summary, bool complete) {
  Json json{{"format", "maximin-campaign"},
            {"version", 1},
            {"maximin", MAXIMIN_VERSION},
            {"configuration", told_configuration(options)},
            {"complete", complete}};
  json["exit_code"] = exit_code(outcome(summary, complete, examination_options(options)));
  json["summary"] = to_json(summary);
  return json;
}

}  // namespace

int run_campaign_command(const Options& options) {
  if (!options.save_model.empty()) throw InputError("--save-model: of which trial? expected --replay TRIAL beside it");
  const ModelSource source = model_source(options);
  examination_options(options);              // bad claims too
  draw_trial(campaign(options), source, 0);  // bad restrictions end the run before any file is made
  if (!options.report.empty()) check_folder_of(options.report);
  std::optional<TrialFile> file = trial_file(options);
  const std::vector<TrialRecord> records = gather(options, source, file);
  const CampaignSummary summary = summarise(records);
  const bool complete = static_cast<long>(records.size()) == options.trials;

  for (const Claim& c : claims()) {
    const long trial = summary.claims[static_cast<std::size_t>(c.id)].first_violation;
    if (trial < 0) continue;
    save_violation(options, draw_trial(campaign(options), source, trial).model, trial, c.id);
  }
  if (options.json) {
    apps::print(apps::json_text(summary_json(options, summary, complete)));
  } else {
    apps::print(verdict_text(summary, examination_options(options), replay_options(options), complete));
  }
  if (!options.report.empty()) {
    write_file(options.report, html_report(told_configuration(options), records, summary, replay_options(options)),
               Overwrite::replace);
  }
  return exit_code(outcome(summary, complete, examination_options(options)));
}

int run_replay_command(const Options& options) {
  const DrawnModel drawn = draw_trial(campaign(options), model_source(options), *options.replay);
  if (!options.save_model.empty() && std::filesystem::exists(options.save_model)) {
    throw InputError(fmt::format("--save-model: {} exists, expected a new name", options.save_model));
  }
  const TrialRecord record = run_trial(campaign(options), drawn, *options.replay);
  const ExaminationOptions asked = examination_options(options);
  if (!options.save_model.empty()) write_model(options.save_model, drawn.model);
  if (!options.report.empty()) {
    const auto rounds = round_series(drawn.model.mdp, make_perturbation(drawn.model), examination_options(options));
    write_file(options.report, html_report(told_configuration(options), record, rounds), Overwrite::replace);
  }
  if (options.json) {
    Json json = header(options);
    json["format"] = "maximin-trial";
    json["configuration"] = told_configuration(options);
    json["exit_code"] = exit_code(outcome(record.found, asked));
    json["record"] = to_json(told(record, asked));
    apps::print(apps::json_text(json));
  } else {
    const std::string title = fmt::format("trial {} of seed {} ({})", record.trial, options.seed, record.family);
    apps::print(verdict_text(title, drawn.model, record.found, asked));
  }
  return exit_code(outcome(record.found, asked));
}

}  // namespace maximin::verify_bound
