#include <maximin/apps/common/progress.hpp>

#include <cstdio>
#include <utility>

#include <fmt/format.h>

#include <maximin/apps/common/terminal.hpp>

namespace maximin::apps {
namespace {

constexpr auto refresh = std::chrono::milliseconds(100);
constexpr int bar_width = 30;

std::string seconds(double s) {
  if (s < 90) return fmt::format("{:.0f} s", s);
  return s < 5400 ? fmt::format("{:.0f} min", s / 60) : fmt::format("{:.1f} h", s / 3600);
}

}  // namespace

Progress::Progress(std::string unit, long total, long done, bool quiet)
    : unit_(std::move(unit)),
      total_(total),
      done_(done),
      done_before_(done),
      visible_(!quiet && stderr_is_terminal()),
      start_(Clock::now()),
      drawn_(start_) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void Progress::advance(const std::string& note) {
  ++done_;
  if (!visible_) return;
  const auto now = Clock::now();
  if (now - drawn_ < refresh && done_ < total_) return;
  draw(note, now);
  drawn_ = now;
}

void Progress::draw(const std::string& note, Clock::time_point now) {
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double rate = elapsed > 0 ? static_cast<double>(done_ - done_before_) / elapsed : 0;
  const int full = static_cast<int>(share * bar_width);
  const std::string left = rate > 0 ? seconds(static_cast<double>(total_ - done_) / rate) : "?";
  fmt::print(stderr, "\r\033[K[{:=<{}}{: <{}}] {}/{} {}  {:.0f}/s  {} left  {}", "", full, "", bar_width - full, done_,
             total_, unit_, rate, left, note);
  std::fflush(stderr);
}

StageProgress::StageProgress(std::string title, bool quiet)
    : title_(std::move(title)),
      stage_("begins"),
      on_terminal_(stderr_is_terminal()),
      start_(std::chrono::steady_clock::now()) {
  if (quiet) return;
  drawing_.emplace([this](const std::stop_token& stop) {
    const std::chrono::milliseconds pause = on_terminal_ ? std::chrono::milliseconds(500) : std::chrono::minutes(1);
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, stop, pause, [&] { return stop.stop_requested(); })) draw();
  });
}

StageProgress::~StageProgress() {
  if (!drawing_) return;
  drawing_.reset();  // joined
  if (on_terminal_) fmt::print(stderr, "\r\033[K");
}

void StageProgress::stage(std::string text) {
  if (!drawing_) return;
  const std::lock_guard lock(mutex_);
  stage_ = std::move(text);
}

void StageProgress::stage(const char* text, long n) {
  if (drawing_) stage(n < 0 ? std::string(text) : fmt::format("{} {}", text, n));
}

void StageProgress::draw() {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  fmt::print(stderr, "{}{}: {}, {} so far{}", on_terminal_ ? "\r\033[K" : "", title_, stage_, seconds(elapsed),
             on_terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace maximin::apps
