#include <maximin/proofs_check/campaign.hpp>

#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// Puts records that arrive in any order into the order of their trials.
class Reorder {
 public:
  Reorder(long first, const RecordSink& sink) : next_(first), sink_(sink) {}

  void take(TrialRecord&& record) {
    const std::lock_guard lock(mutex_);
    waiting_.emplace(record.trial, std::move(record));
    while (!waiting_.empty() && waiting_.begin()->first == next_) {
      // Taken out before the sink sees it: if the sink throws, no other thread may hand it over again.
      auto ready = waiting_.extract(waiting_.begin());
      sink_(std::move(ready.mapped()));
      ++next_;
    }
  }

  long next() const { return next_; }

 private:
  std::mutex mutex_;
  long next_;
  const RecordSink& sink_;
  std::map<long, TrialRecord> waiting_;
};

/// Hands a certificate on with the time since now.
std::function<void(const std::string&)> timed(const Campaign& campaign, long trial) {
  if (!campaign.certified) return {};
  const auto start = std::chrono::steady_clock::now();
  return [&campaign, trial, start](const std::string& json) {
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    campaign.certified(trial, json, taken.count());
  };
}

}  // namespace

DrawnModel draw_trial(const Campaign& campaign, const ModelSource& source, long trial) {
  Stream rng(campaign.seed, static_cast<std::uint64_t>(trial));
  return source(rng);
}

TrialRecord run_trial(const Campaign& campaign, const DrawnModel& drawn, long trial) {
  TrialRecord record{trial, drawn.family, {}, drawn.score};
  try {
    record.found = campaign.examination.exact
                       ? examine_exactly(rationalise(drawn.model), {}, campaign.examination, timed(campaign, trial))
                       : examine(drawn.model.mdp, make_perturbation(drawn.model), campaign.examination);
  } catch (const BudgetExhausted&) {
    record.found = {};
    record.found.states = drawn.model.mdp.states();
    record.found.actions = drawn.model.mdp.actions();
    record.found.discount = drawn.model.mdp.discount();
    for (Check& check : record.found.checks) check.verdict = Verdict::undetermined;
  }
  return record;
}

long run_campaign(const Campaign& campaign, const ModelSource& source, const RecordSink& sink,
                  const std::atomic<bool>& stop) {
  Reorder reorder(campaign.first, sink);
  std::atomic<long> next{campaign.first};
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::once_flag first_failure;

  const auto work = [&] {
    try {
      while (!stop && !failed) {
        const long trial = next++;
        if (trial >= campaign.trials) return;
        reorder.take(run_trial(campaign, draw_trial(campaign, source, trial), trial));
      }
    } catch (const Interrupted&) {
      return;  // the trial in progress is given up; it was never finished
    } catch (...) {
      std::call_once(first_failure, [&] { failure = std::current_exception(); });
      failed = true;
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < campaign.threads; ++i) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  return reorder.next() - campaign.first;
}

}  // namespace maximin
