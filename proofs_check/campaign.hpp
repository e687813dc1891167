#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <maximin/models/model.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/proofs_check/trial_record.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// A random model and the family it was drawn from.
struct DrawnModel {
  std::string family;
  Model<double> model;
  std::optional<double> score = {};  ///< of a search, kept in the record
};

/// Draws the model of a trial. Must be a function of the stream alone, and safe to call from several threads.
using ModelSource = std::function<DrawnModel(Stream&)>;

/// Many models, each examined; trial k is a function of (seed, k) whatever the threads.
///
/// `certified` is called with each certificate of an exact campaign and the seconds that it took to make, from several
/// threads at once.
struct Campaign {
  std::uint64_t seed = 1;
  long trials = 2000;
  long first = 0;  ///< trials before it are known already (a resumed run)
  int threads = 1;
  ExaminationOptions examination = {};
  std::function<void(long trial, const std::string& json, double seconds)> certified = {};
};

/// Takes the records in order of the trials, from one thread at a time. May throw; the campaign then ends, and the sink
/// is not called again.
using RecordSink = std::function<void(TrialRecord&&)>;

/// The model of trial k.
DrawnModel draw_trial(const Campaign& campaign, const ModelSource& source, long trial);

/// Examines trial k, whose model was drawn. A solver that runs out of its budget makes every claim undetermined.
TrialRecord run_trial(const Campaign& campaign, const DrawnModel& drawn, long trial);

/// Runs the campaign. `stop` ends it early, with all records before the first missing one handed to the sink.
/// Returns how many trials the sink has seen in this run.
long run_campaign(const Campaign& campaign, const ModelSource& source, const RecordSink& sink,
                  const std::atomic<bool>& stop);

}  // namespace maximin
