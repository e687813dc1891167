#include "falsify_command.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/proofs_check/campaign.hpp>
#include <maximin/proofs_check/falsify/climb.hpp>
#include <maximin/proofs_check/falsify/goal.hpp>
#include <maximin/proofs_check/trial_file.hpp>
#include <maximin/theory/error.hpp>

#include "options.hpp"
#include "outcome.hpp"
#include "shared_options.hpp"
#include "violation.hpp"

namespace maximin::verify_bound {
namespace {

/// Raises the flag that ends a search when its time is up, unless it ended before.
class Deadline {
 public:
  Deadline(std::atomic<bool>& flag, std::chrono::milliseconds time) {
    thread_ = std::jthread([this, &flag, time](const std::stop_token& stop) {
      std::unique_lock lock(mutex_);
      if (!wake_.wait_for(lock, stop, time, [] { return false; }) && !stop.stop_requested()) flag = true;
    });
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

/// What a search for one goal came to.
struct Found {
  const Goal* goal;
  long restarts = 0;
  std::optional<Model<double>> model;  ///< shrunk
  double score = 0;
  Verdict proved = Verdict::undetermined;  ///< of the goal in exact arithmetic; holds: not refuted
  const Goal* found_for = nullptr;         ///< the goal whose search found the model
  std::string file;

  bool hit() const { return model && (score > goal->threshold || proved == Verdict::violated); }
};

ExaminationOptions examination(const FalsifyCommand& o) {
  ExaminationOptions e;
  e.reading = reading_named(o.reading);
  e.tie = tie_named(o.tie);
  e.max_iterations = 2'000;
  e.max_belief_positions = 2'000;
  return e;
}

std::vector<const Goal*> goals_asked(const FalsifyCommand& o) {
  std::vector<const Goal*> list;
  std::vector<std::string> names;
  for (const Goal& g : goals()) names.push_back(g.name);
  for (const std::string& name : o.goals.empty() ? names : o.goals) {
    const Goal* goal = find_goal(name);
    if (goal == nullptr) {
      throw InputError(fmt::format("--goal: '{}' is unknown, expected one of {}", name, fmt::join(names, ", ")));
    }
    list.push_back(goal);
  }
  return list;
}

/// Restart k draws a model and climbs from it: a function of (seed, k), whatever the threads and the time.
ModelSource climbing_source(const FalsifyCommand& o, const Goal& goal, const std::atomic<bool>& stop) {
  FamilyOptions small;
  small.states = state_range(o.states);
  return
      [&goal, &stop, small, family = family_named(o.family), steps = o.steps, options = examination(o)](Stream& rng) {
        FamilyMember start = draw_family_member(family, small, rng);
        const auto of_model = [&](const Model<double>& model) {
          if (stop) throw Interrupted();
          return score(goal, model, options);
        };
        Climb best = climb(std::move(start.model), of_model, steps, rng);
        return DrawnModel{std::string(family_name(start.family)), std::move(best.model), best.score};
      };
}

nlohmann::ordered_json header(const FalsifyCommand& o, const Goal& goal) {
  return {{"format", "maximin-search"}, {"version", 1},  {"maximin", MAXIMIN_VERSION}, {"goal", goal.name},
          {"reading", o.reading},       {"tie", o.tie},  {"states", o.states},         {"family", o.family},
          {"steps", o.steps},           {"seed", o.seed}};
}

std::optional<TrialFile> trial_file(const FalsifyCommand& o, const Goal& goal) {
  if (o.trials_out.empty()) return std::nullopt;
  const std::string path = fmt::format("{}-{}.jsonl", o.trials_out, goal.name);
  return o.resume ? TrialFile::resume(path, header(o, goal)) : TrialFile::create(path, header(o, goal));
}

/// Restarts until the budget is used up; the best score of each, those of the file first.
std::vector<double> scores(const FalsifyCommand& o, const Goal& goal, std::chrono::milliseconds time) {
  std::atomic<bool> stop{false};
  std::optional<TrialFile> file = trial_file(o, goal);
  std::vector<double> found;
  if (file) {
    for (const TrialRecord& r : file->finished()) found.push_back(r.score.value_or(-INFINITY));
  }
  Campaign c;
  c.seed = o.seed;
  c.first = static_cast<long>(found.size());
  c.trials = o.restarts;
  c.threads = threads_for(o.threads);
  c.examination = examination(o);
  c.examination.only.emplace();
  if (goal.claim) c.examination.only->insert(*goal.claim);
  double best = -INFINITY;
  for (const double s : found) best = std::max(best, s);
  apps::Progress progress(fmt::format("restarts for {}", goal.name), c.trials, c.first, o.quiet || o.json);
  const Deadline deadline(stop, time);
  run_campaign(
      c, climbing_source(o, goal, stop),
      [&](TrialRecord&& record) {
        if (file) file->append(record);
        found.push_back(record.score.value_or(-INFINITY));
        best = std::max(best, found.back());
        progress.advance(fmt::format("best {:.6g}", best));
        if (apps::stop_on_interrupt()) stop = true;
      },
      stop);
  return found;
}

/// The model that a restart ended with, made small: a hit stays one, any other keeps all but a thousandth of its score.
Model<double> shrunk_model(const FalsifyCommand& o, const Goal& goal, long restart, double best) {
  const std::atomic<bool> never{false};
  Stream rng(o.seed, static_cast<std::uint64_t>(restart));
  const DrawnModel drawn = climbing_source(o, goal, never)(rng);
  const bool hit = best > goal.threshold;
  const auto keeps = [&](const Model<double>& m) {
    const double s = score(goal, m, examination(o));
    return hit ? s > goal.threshold : s >= best - std::abs(best) / 1000;
  };
  return shrink(drawn.model, keeps, 3'000);
}

/// The restarts from the best down.
std::vector<long> ranked(const std::vector<double>& scores) {
  std::vector<long> order;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    if (scores[k] > -INFINITY) order.push_back(static_cast<long>(k));
  }
  std::stable_sort(order.begin(), order.end(), [&](long x, long y) {
    return scores[static_cast<std::size_t>(x)] > scores[static_cast<std::size_t>(y)];
  });
  return order;
}

/// Of the best restarts, the first whose model exact arithmetic decides; the very best, where it decides none.
Found search(const FalsifyCommand& o, const Goal& goal, std::chrono::milliseconds time) {
  constexpr std::size_t most_tries = 10;
  const std::vector<double> all = scores(o, goal, time);
  Found found{&goal, static_cast<long>(all.size()), std::nullopt, -INFINITY, Verdict::undetermined, &goal, ""};
  const std::vector<long> order = ranked(all);
  for (std::size_t i = 0; i < std::min(most_tries, order.size()); ++i) {
    const double best = all[static_cast<std::size_t>(order[i])];
    if (found.hit() && !(best > goal.threshold)) break;
    Model<double> model = shrunk_model(o, goal, order[i], best);
    const Verdict verdict = proved(goal, model, examination(o));
    if (found.model && verdict == Verdict::undetermined) continue;
    found.score = score(goal, model, examination(o));
    found.proved = verdict;
    found.model = std::move(model);
    if (verdict != Verdict::undetermined) break;
  }
  return found;
}

/// Tries the models of the other goals on this one, and takes the best of those that exact arithmetic says no less of.
void adopt(const FalsifyCommand& o, Found& to, const std::vector<Found>& all) {
  const Found own = to;
  for (const Found& from : all) {
    if (from.goal == own.goal || !from.model) continue;
    const double better = score(*own.goal, *from.model, examination(o));
    if (!(better > to.score)) continue;
    const Verdict verdict = proved(*own.goal, *from.model, examination(o));
    if (verdict == Verdict::undetermined && own.proved != Verdict::undetermined) continue;
    to = {own.goal, own.restarts, from.model, better, verdict, from.goal, ""};
  }
}

/// What each search found, on the best model of them all, which is written.
std::vector<Found> shared(const FalsifyCommand& o, const std::vector<Found>& searched) {
  std::vector<Found> all = searched;
  for (Found& f : all) {
    adopt(o, f, searched);
    if (!f.model) continue;
    f.model->name = fmt::format("{}: score {:.6g} (falsify, seed {})", f.goal->name, f.score, o.seed);
    f.file = save_under_new_name(
        std::filesystem::path(o.directory) / fmt::format("falsify-{}-{}", o.seed, f.goal->name), *f.model);
  }
  return all;
}

const char* what_is_proved(const Found& f) {
  switch (f.proved) {
    case Verdict::violated:
      return "refuted, proved exactly";
    case Verdict::holds:
      return "holds there, proved exactly";
    default:
      return "not decided exactly";
  }
}

/// What a search came to, in one line.
std::string verdict_sentence(const Found& f) {
  const std::string what = fmt::format("{} ({})", f.goal->name, f.goal->title);
  if (!f.model) return fmt::format("{}: undetermined, no model was decided.\n", what);
  if (!f.hit()) {
    return fmt::format("{}: not refuted in {} restart{}; the highest score is {}, and above {} would refute it.\n",
                       what, f.restarts, f.restarts == 1 ? "" : "s", apps::number(f.score),
                       apps::number(f.goal->threshold));
  }
  const char* how = f.proved == Verdict::violated ? "REFUTED, proved exactly"
                    : f.proved == Verdict::holds
                        ? "REFUTED in floating point with certified error, but on the decimals of its model it holds"
                        : "REFUTED in floating point with certified error, not proved exactly";
  return fmt::format("{}: {}: score {} on {}.\n", what, how, apps::number(f.score), f.file);
}

std::string results_text(const std::vector<Found>& all) {
  std::string verdicts;
  apps::Table table;
  table.column("goal", apps::Align::left).column("", apps::Align::left).column("restarts");
  table.column("highest score", apps::Align::point).column("hit above").column("on that model", apps::Align::left);
  table.column("file", apps::Align::left);
  for (const Found& f : all) {
    table.row({f.goal->name, f.goal->title, std::to_string(f.restarts), f.model ? apps::number(f.score) : "-",
               apps::number(f.goal->threshold), f.model ? what_is_proved(f) : "no model was decided", f.file});
    verdicts += verdict_sentence(f);
  }
  return table.text() +
         "\nThe score of a claim is left/right: 1 is attained, above 1 refuted. Of settling it is the period (below 1: "
         "it\n"
         "settles); of sharper-belief the loss as a part of span(R)/(1-gamma).\n\n" +
         verdicts;
}

nlohmann::ordered_json results_json(const std::vector<Found>& all) {
  nlohmann::ordered_json json{{"format", "maximin-falsify"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}};
  for (const Found& f : all) {
    json["goals"].push_back({{"goal", f.goal->name},
                             {"restarts", f.restarts},
                             {"score", f.model ? nlohmann::ordered_json(f.score) : nlohmann::ordered_json(nullptr)},
                             {"threshold", f.goal->threshold},
                             {"hit", f.hit()},
                             {"proved", f.model ? what_is_proved(f) : ""},
                             {"found_for", f.model ? f.found_for->name : ""},
                             {"file", f.file}});
  }
  return json;
}

}  // namespace

void declare(CLI::App& command, FalsifyCommand& o) {
  command
      .add_option("--goal", o.goals, "claims to hunt, settling, sharper-belief, separated by\ncommas (default: all)")
      ->delimiter(',')
      ->type_name("LIST");
  command.add_option("--seconds", o.seconds, fmt::format("time for all goals together (default: {})", o.seconds))
      ->check(apps::whole_number(1, 10'000'000))
      ->type_name("N");
  command.add_option("--restarts", o.restarts, "random starts for each goal, at most")
      ->check(apps::whole_number(1, 1'000'000'000))
      ->type_name("N");
  command.add_option("--steps", o.steps, fmt::format("changes tried from each start (default: {})", o.steps))
      ->check(apps::whole_number(0, 100'000'000))
      ->type_name("N");
  command.add_option("--states", o.states, fmt::format("number of states (default: {})", o.states))
      ->type_name("LOW:HIGH");
  add_family(command, o.family, "models to start from (default: mixed)");
  add_reading(command, o.reading);
  add_tie(command, o.tie);
  add_seed(command, o.seed, "start K of a seed climbs to the same model always (default: 1)");
  add_threads(command, o.threads, "0 takes one per core (the default)");
  command
      .add_option("--model-dir", o.directory, "folder where the best model of each goal is written\n(default: here)")
      ->check(apps::existing_folder())
      ->type_name("DIR");
  command.add_option("--trials-out", o.trials_out, "write one JSON line per start to NAME-GOAL.jsonl")
      ->type_name("NAME");
  command.add_flag("--resume", o.resume, "go on with those files");
  command.add_flag("--json", o.json, "one JSON object on standard output, nothing else");
  command.add_flag("--quiet", o.quiet, "no progress bar");
}

int run_falsify_command(const FalsifyCommand& options) {
  if (options.resume && options.trials_out.empty()) {
    throw InputError("--resume: nothing to resume, expected --trials-out NAME beside it");
  }
  state_range(options.states);
  const std::vector<const Goal*> asked = goals_asked(options);
  const auto each = std::chrono::milliseconds(1000 * options.seconds / static_cast<long>(asked.size()));
  std::vector<Found> all;
  for (const Goal* goal : asked) {
    all.push_back(search(options, *goal, each));
    if (apps::stop_on_interrupt()) break;
  }
  all = shared(options, all);
  apps::print(options.json ? apps::json_text(results_json(all)) : results_text(all));
  const bool complete = all.size() == asked.size() && !apps::stop_on_interrupt() &&
                        std::all_of(all.begin(), all.end(), [](const Found& f) { return f.model.has_value(); });
  if (!complete) apps::note("the search ended before every goal had a model: more time (--seconds) may find one");
  const bool violated = std::any_of(all.begin(), all.end(), [](const Found& f) { return f.goal->claim && f.hit(); });
  if (violated) return apps::ExitCode::violated;
  return complete ? apps::ExitCode::success : apps::ExitCode::undetermined;
}

}  // namespace maximin::verify_bound
