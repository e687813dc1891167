#include <maximin/apps/maximin_deep/workers.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace maximin::apps {
namespace {

using Clock = std::chrono::steady_clock;

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

void run_in_parallel(const std::vector<std::function<void()>>& jobs, int threads, const std::atomic<bool>& stop) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    while (!stop && !failed) {
      const std::size_t job = next++;
      if (job >= jobs.size()) return;
      try {
        jobs[job]();
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        failed = true;
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (int t = 1; t < threads; ++t) pool.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

std::vector<std::optional<deep::TrainedAgent>> train_side_by_side(std::vector<deep::AgentSpec> specs,
                                                                  const std::filesystem::path& folder,
                                                                  torch::Device device, const deep::Effort& effort,
                                                                  int threads, WorkLine& line,
                                                                  const std::atomic<bool>& stop) {
  std::set<std::string> names;
  std::erase_if(specs, [&](const deep::AgentSpec& s) { return !names.insert(s.name()).second; });
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const auto first = deep::beginning_of(specs[i], effort);
    if (first && names.insert(first->name()).second) specs.push_back(*first);
  }
  // What others begin with comes before them, each training once.
  std::map<int, std::vector<std::size_t>> by_depth;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    int depth = 0;
    for (auto first = deep::beginning_of(specs[i], effort); first; first = deep::beginning_of(*first, effort)) ++depth;
    by_depth[depth].push_back(i);
  }
  std::vector<std::optional<deep::TrainedAgent>> trained(specs.size());
  std::atomic<long> done = 0;
  for (const auto& [depth, of_depth] : by_depth) {
    std::vector<std::function<void()>> jobs;
    for (const std::size_t i : of_depth) {
      jobs.emplace_back([&, i] {
        trained[i] = deep::train_agent(specs[i], folder, device, effort, line.hooks(stop));
        line.say("");
        line.done(++done, static_cast<long>(specs.size()));
      });
    }
    run_in_parallel(jobs, threads, stop);
  }
  return trained;
}

WorkLine::WorkLine(std::string title) : progress_(std::move(title)) {}

void WorkLine::show() {
  std::string text = of_ > 0 ? fmt::format("{} of {}", done_, of_) : "";
  for (const auto& [thread, line] : lines_) {
    if (!text.empty()) text += "; ";
    text += line;
  }
  progress_.stage(text);
}

void WorkLine::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (text.empty()) {
    lines_.erase(std::this_thread::get_id());
  } else {
    lines_[std::this_thread::get_id()] = text;
  }
  show();
}

void WorkLine::done(long jobs, long of) {
  const std::lock_guard lock(mutex_);
  done_ = jobs;
  of_ = of;
  show();
}

deep::TrainingHooks WorkLine::hooks(const std::atomic<bool>& stop) {
  struct State {
    std::string part;
    long frames = 0, first = -1;
    Clock::time_point start;
  };
  auto state = std::make_shared<State>();
  deep::TrainingHooks hooks;
  hooks.begin = [this, state](const std::string& part, long frames) {
    *state = {part, frames, -1, Clock::now()};
    say(part);
  };
  hooks.stretch = [this, state, &stop](const deep::CurvePoint& point) {
    if (state->first < 0) {
      state->first = point.frames;
      state->start = Clock::now();
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - state->start).count();
    const double rate = static_cast<double>(point.frames - state->first) / std::max(seconds, 1e-9);
    std::string line = fmt::format("{} {:.0f} %", state->part,
                                   100.0 * static_cast<double>(point.frames) / static_cast<double>(state->frames));
    if (!std::isnan(point.mean_return)) line += fmt::format(", return {:.0f}", point.mean_return);
    if (rate > 0 && point.frames > state->first) {
      line += fmt::format(", {:.0f} frames/s, {} left", rate,
                          duration(static_cast<double>(state->frames - point.frames) / rate));
    }
    say(line);
    return !stop.load();
  };
  return hooks;
}

}  // namespace maximin::apps
