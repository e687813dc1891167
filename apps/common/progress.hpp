#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace maximin::apps {

/// A progress bar on standard error, drawn only when that is a terminal. Not safe for several threads at once.
///
///     Progress progress("trials", 2000);
///     progress.advance();          // after each
class Progress {
 public:
  /// `total` > 0 things named `unit` to do, `done` of them already. Nothing is ever drawn when `quiet`.
  Progress(std::string unit, long total, long done = 0, bool quiet = false);
  /// Clears the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more is done; `note` is shown behind the bar.
  void advance(const std::string& note = {});

 private:
  using Clock = std::chrono::steady_clock;
  void draw(const std::string& note, Clock::time_point now);

  std::string unit_;
  long total_;
  long done_;
  long done_before_;
  bool visible_;
  Clock::time_point start_;
  Clock::time_point drawn_;
};

/// What a long piece of work is doing, and for how long, on one line of standard error; where that is no terminal, on
/// a line of its own every minute. A thread of its own draws it, so that the time goes on while the work is silent.
///
///     StageProgress progress("certify");
///     progress.stage("round 17");      // certify: round 17, 42 s so far
class StageProgress {
 public:
  /// Nothing is ever drawn when `quiet`.
  explicit StageProgress(std::string title, bool quiet = false);
  /// Clears the line.
  ~StageProgress();
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;

  /// This is begun.
  void stage(std::string text);
  /// The same in the form in which exact work tells it: n < 0 is none.
  void stage(const char* text, long n);

 private:
  void draw();

  std::string title_;
  std::string stage_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::jthread> drawing_;  ///< none where nothing is said
};

}  // namespace maximin::apps
