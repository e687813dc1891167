#include <maximin/deep/report/animation.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <maximin/deep/report/map_marks.hpp>
#include <maximin/deep/report/map_picture.hpp>
#include <maximin/deep/report/results.hpp>
#include <maximin/deep/report/svg_canvas.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

constexpr double margin = 16, head = 66, foot = 78;

/// When things happen, as shares of one round: step k begins at at(k); the agent stands, then moves in the last part.
class Clock {
 public:
  Clock(const EpisodeTrace& trace, const AnimationOptions& o)
      : steps_(trace.steps.size()),
        step_(o.seconds_per_step),
        seconds_(o.seconds_per_step * static_cast<double>(trace.steps.size()) + o.hold_seconds) {}

  /// A share of the round, written.
  std::string at(double step) const { return fmt::format("{:.5g}", std::min(1.0, step * step_ / seconds_)); }
  std::string duration() const { return fmt::format("{:.5g}s", seconds_); }
  std::size_t steps() const { return steps_; }
  /// The part of a step for which the agent stands still.
  static constexpr double standing = 0.55;

  /// A number that stands, then moves from value[k] to value[k+1] in step k; one value more than steps.
  std::string moving(std::string_view attribute, const std::vector<double>& value) const {
    std::string values = svg_number(value[0]), times = "0";
    for (std::size_t k = 0; k < steps_; ++k) {
      values += ';' + svg_number(value[k]) + ';' + svg_number(value[k + 1]);
      times += ';' + at(static_cast<double>(k) + standing) + ';' + at(static_cast<double>(k + 1));
    }
    return fmt::format(
        "<animate attributeName=\"{}\" values=\"{};{}\" keyTimes=\"{};1\" dur=\"{}\" repeatCount=\"indefinite\"/>",
        attribute, values, svg_number(value[steps_]), times, duration());
  }

  /// Visible in step k alone; k = steps() is the end.
  std::string only_in(std::size_t k) const {
    const std::string from = at(static_cast<double>(k)), to = at(static_cast<double>(k + 1));
    const bool first = k == 0, last = k == steps_;
    return fmt::format(
        "<animate attributeName=\"visibility\" calcMode=\"discrete\" values=\"{}{}\" keyTimes=\"{}{}\" dur=\"{}\" "
        "repeatCount=\"indefinite\"/>",
        first ? "visible" : "hidden;visible", last ? "" : ";hidden", first ? "0" : "0;" + from, last ? "" : ";" + to,
        duration());
  }

 private:
  std::size_t steps_;
  double step_, seconds_;
};

/// The true position at each time, the end included.
std::vector<Point> places_of(const EpisodeTrace& trace) {
  std::vector<Point> places;
  for (const TraceStep& s : trace.steps) places.push_back(s.truth);
  places.push_back(trace.end);
  return places;
}

std::string signed_reward(double r) {
  return fmt::format("{}{:g}", r < 0 ? "−" : "+", std::abs(r));
}

std::string plain_reward(double r) {
  return fmt::format("{}{:g}", r < 0 ? "−" : "", std::abs(r));
}

/// The words of a step on the line above the map: time at the left, move in the middle, return at the right.
std::string step_words(const MapFrame& f, std::size_t time, const std::string& what, double total) {
  return svg_text(f.left, head - 12, fmt::format("t = {}", time), "strong") +
         svg_text(f.left + f.extent / 2, head - 12, what, "mid") +
         svg_text(f.left + f.extent, head - 12, "return " + plain_reward(total), "strong end");
}

/// Where the legend speaks of the belief.
Point belief_key(const MapFrame& f) {
  return {f.left + 150, f.top + f.extent + 64};
}

/// What the belief is, in the legend of a step: its area tells how much the agent knows.
std::string belief_words(const MapFrame& f, const TraceBelief& belief) {
  std::string words = "held possible";
  if (!belief.boxes.empty()) {
    const double area = BoxUnion(belief.boxes).area();
    words += area < 1e-6 ? ", one place" : fmt::format(", area {:.2g}", area);
  }
  if (belief.points.size() == 1) words += ", one place";
  if (belief.points.size() > 1) words += fmt::format(", {} particles", belief.points.size());
  return svg_text(belief_key(f).x + 26, belief_key(f).y, words);
}

/// All that is seen in one step and no other.
std::string step_group(const MapFrame& f, const EpisodeTrace& trace, const AnimationOptions& o, const Clock& clock,
                       std::size_t k, Point next, double total) {
  const TraceStep& s = trace.steps[k];
  std::string svg = fmt::format("<g visibility=\"{}\">{}\n", k == 0 ? "visible" : "hidden", clock.only_in(k));
  if (o.belief) svg += belief_marks(f, s.belief);
  if (o.belief && !s.belief.empty()) svg += belief_words(f, s.belief);
  svg += ball_mark(f, s.truth, trace.eps) + svg_move(f, s.truth, s.action, next == s.truth);
  svg += shown_mark(f, s.truth, s.shown);
  const bool cancelled = next == s.truth;
  const auto name = gridworld::moves[static_cast<std::size_t>(s.action)].name;
  svg += step_words(f, k, fmt::format("{}{} {}", name, cancelled ? " (blocked)" : "", signed_reward(s.reward)), total);
  return svg + "</g>\n";
}

std::string end_group(const MapFrame& f, const EpisodeTrace& trace, const Clock& clock, bool belief) {
  const gridworld::Cell cell = gridworld::cell(trace.end);
  const char* what = !trace.terminal                 ? "time is up"
                     : cell == gridworld::Cell::gold ? "reached the gold"
                     : cell == gridworld::Cell::bomb ? "hit the bomb"
                                                     : "over";
  return fmt::format("<g visibility=\"hidden\">{}\n{}{}</g>\n", clock.only_in(trace.steps.size()),
                     step_words(f, trace.steps.size(), what, trace.total_reward()), belief ? belief_words(f, {}) : "");
}

/// The path, which grows: a dash as long as what has been walked.
std::string growing_path(const MapFrame& f, const std::vector<Point>& places, const Clock& clock) {
  std::string d = "M" + f.place(places[0]);
  std::vector<double> walked{0};
  for (std::size_t k = 1; k < places.size(); ++k) {
    d += "L" + f.place(places[k]);
    walked.push_back(walked.back() + f.unit * std::hypot(places[k].x - places[k - 1].x, places[k].y - places[k - 1].y));
  }
  const double all = std::max(1.0, walked.back());
  std::vector<double> hidden;
  for (const double w : walked) hidden.push_back(all - w);
  // The gap after the dash is longer than the path, so that rounding shows no speck at its end.
  const std::string dash = fmt::format("stroke-dasharray=\"{0} {1}\" stroke-dashoffset=\"{0}\" pathLength=\"{0}\"",
                                       svg_number(all), svg_number(all + 9));
  const std::string grow = clock.moving("stroke-dashoffset", hidden);
  return fmt::format(
      "<path class=\"halo grow\" d=\"{0}\" {1}>{2}</path>\n<path class=\"path grow\" d=\"{0}\" {1}>{2}</path>\n", d,
      dash, grow);
}

std::string moving_truth(const MapFrame& f, const std::vector<Point>& places, const Clock& clock) {
  std::vector<double> x, y;
  for (const Point& p : places) {
    x.push_back(f.x(p.x));
    y.push_back(f.y(p.y));
  }
  return fmt::format("<circle class=\"truth\" cx=\"{}\" cy=\"{}\" r=\"7\">{}{}</circle>\n", svg_number(x[0]),
                     svg_number(y[0]), clock.moving("cx", x), clock.moving("cy", y));
}

std::string time_bar(const MapFrame& f, const Clock& clock) {
  const double y = f.top + f.extent + 10;
  std::vector<double> width;
  for (std::size_t k = 0; k <= clock.steps(); ++k) {
    width.push_back(f.extent * static_cast<double>(k) / static_cast<double>(clock.steps()));
  }
  return fmt::format(
      "<rect class=\"track\" x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"5\" rx=\"2.5\"/>\n"
      "<rect class=\"fill\" x=\"{0}\" y=\"{1}\" width=\"0\" height=\"5\" rx=\"2.5\">{3}</rect>\n",
      svg_number(f.left), svg_number(y), svg_number(f.extent), clock.moving("width", width));
}

std::string legend(const MapFrame& f, const EpisodeTrace& trace, bool belief) {
  const Point key = belief_key(f);
  const double y2 = key.y, y1 = y2 - 26, x1 = f.left + 10, x2 = key.x;
  std::string svg =
      fmt::format("<circle class=\"truth\" cx=\"{}\" cy=\"{}\" r=\"7\"/>", svg_number(x1), svg_number(y1 - 5));
  svg += svg_text(x1 + 16, y1, "true position");
  svg +=
      fmt::format("<circle class=\"shown\" cx=\"{0}\" cy=\"{1}\" r=\"6\"/><path class=\"shown\" d=\"M{2}h8m-4 -4v8\"/>",
                  svg_number(x1), svg_number(y2 - 5), svg_place(x1 - 4, y2 - 5));
  svg += svg_text(x1 + 16, y2, "shown to it");
  if (trace.eps > 0) {
    svg += fmt::format("<rect class=\"ball\" x=\"{}\" y=\"{}\" width=\"18\" height=\"14\"/>", svg_number(x2),
                       svg_number(y1 - 12));
    svg += svg_text(x2 + 26, y1, fmt::format("may be shown, ε = {:g}", trace.eps));
  }
  if (!belief) return svg;
  svg += fmt::format("<rect class=\"belief\" x=\"{}\" y=\"{}\" width=\"18\" height=\"14\"/>", svg_number(x2),
                     svg_number(y2 - 12));
  return svg;
}

}  // namespace

std::string animated_svg(const EpisodeTrace& trace, const AnimationOptions& o) {
  validate(trace, "trace");
  if (trace.steps.empty()) throw InputError("trace: no steps, expected at least one to show");
  if (!(o.seconds_per_step > 0 && o.hold_seconds > 0 && o.seconds_per_step <= 60 && o.hold_seconds <= 600)) {
    throw InputError("animation: seconds per step and at the end, expected positive numbers, at most 60 and 600");
  }
  const MapFrame f{margin, head};
  const Clock clock(trace, o);
  const std::vector<Point> places = places_of(trace);
  const double width = f.extent + 2 * margin, height = head + f.extent + foot;
  const bool belief = o.belief && std::any_of(trace.steps.begin(), trace.steps.end(),
                                              [](const TraceStep& s) { return !s.belief.empty(); });
  const std::string title = fmt::format("{} against {}", trace.agent, column_title({trace.attack, trace.eps}));
  std::string svg = fmt::format(
      "<svg class=\"map\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\">\n<title>{2}</title>\n"
      "<desc>{3}</desc>\n<rect class=\"backdrop\" width=\"{0}\" height=\"{1}\"/>\n",
      svg_number(width), svg_number(height), report::escape(title), report::escape(trace.outcome()));
  const double room = svg_width(title, 18);
  svg += svg_text(f.left, 26, title, "title",
                  room > f.extent ? fmt::format("style=\"font-size:{}px\"", svg_number(18 * f.extent / room)) : "");
  svg += svg_map(f);
  svg += growing_path(f, places, clock);
  double total = 0;
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    total += trace.steps[k].reward;
    svg += step_group(f, trace, o, clock, k, places[k + 1], total);
  }
  svg += end_group(f, trace, clock, belief) + moving_truth(f, places, clock) + time_bar(f, clock) +
         legend(f, trace, belief);
  return standalone_svg(svg + "</svg>\n");
}

}  // namespace maximin::deep
