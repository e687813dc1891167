#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <maximin/apps/common/progress.hpp>
#include <maximin/deep/trained_agent.hpp>

namespace maximin::apps {

/// Runs the jobs on so many threads, in order of the list. Stops handing out jobs when one throws, or when `stop` is
/// raised, and throws on the first exception when all threads have ended.
void run_in_parallel(const std::vector<std::function<void()>>& jobs, int threads, const std::atomic<bool>& stop);

/// One line that tells what every thread does, and what is done: for trainings that run side by side.
class WorkLine {
 public:
  explicit WorkLine(std::string title);

  /// Hooks for one training; its line is "NAME 43 %, 5120 frames/s, return 178, 2 min left".
  deep::TrainingHooks hooks(const std::atomic<bool>& stop);
  /// What the calling thread does now; empty: nothing.
  void say(const std::string& text);
  /// So many of so many jobs are done.
  void done(long jobs, long of);

 private:
  void show();

  std::mutex mutex_;
  std::map<std::thread::id, std::string> lines_;  // of each thread
  long done_ = 0, of_ = 0;
  StageProgress progress_;
};

/// Trains the agents side by side, before them and once what they begin with, and returns all of them, what others
/// begin with first. Empty ones were stopped.
std::vector<std::optional<deep::TrainedAgent>> train_side_by_side(std::vector<deep::AgentSpec> specs,
                                                                  const std::filesystem::path& folder,
                                                                  torch::Device device, const deep::Effort& effort,
                                                                  int threads, WorkLine& line,
                                                                  const std::atomic<bool>& stop);

}  // namespace maximin::apps
