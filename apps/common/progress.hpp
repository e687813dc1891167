#pragma once

#include <chrono>
#include <string>

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

}  // namespace maximin::apps
