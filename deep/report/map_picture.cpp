#include <maximin/deep/report/map_picture.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <maximin/deep/report/map_marks.hpp>
#include <maximin/deep/report/results.hpp>
#include <maximin/deep/report/svg_canvas.hpp>
#include <maximin/proofs_check/report/html_text.hpp>

namespace maximin::deep {
namespace {

constexpr double map_margin = 2, title_room = 30;

std::string open_map(double height, const std::string& title, const std::string& description) {
  const double width = MapFrame::extent + 2 * map_margin;
  std::string svg = fmt::format("<svg class=\"map\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n",
                                svg_number(width), svg_number(height), report::escape(description));
  if (title.empty()) return svg;
  const double room = svg_width(title, 18);  // a long title is squeezed rather than cut
  const std::string squeeze =
      room > width ? fmt::format("textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"", svg_number(width - 4)) : "";
  return svg + svg_text(map_margin, 20, title, "title", squeeze);
}

/// Through the true positions of the first steps; with `end`, on to where the last one led.
std::string true_path(const MapFrame& f, const EpisodeTrace& trace, std::size_t steps, bool end) {
  std::string d = "M" + f.place(trace.steps.front().truth);
  for (std::size_t k = 1; k < steps; ++k) d += "L" + f.place(trace.steps[k].truth);
  if (end) d += "L" + f.place(trace.end);
  return fmt::format("<path class=\"halo\" d=\"{0}\"/><path class=\"path\" d=\"{0}\"/>\n", d);
}

std::string ring(const MapFrame& f, Point p, double radius) {
  return fmt::format("<circle class=\"shown\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>", svg_number(f.x(p.x)),
                     svg_number(f.y(p.y)), svg_number(radius));
}

/// Every shown position, tied to the true one.
std::string shown_positions(const MapFrame& f, const EpisodeTrace& trace) {
  std::string ties, rings;
  for (const TraceStep& s : trace.steps) {
    if (s.shown == s.truth) continue;
    ties += "M" + f.place(s.truth) + "L" + f.place(s.shown);
    rings += ring(f, s.shown, 3.6);
  }
  return rings.empty() ? "" : fmt::format("<path class=\"tie\" d=\"{}\"/>{}\n", ties, rings);
}

/// Where in the belief to write its number: beside the box that lies highest, or above the mean of the points.
Point corner_of(const TraceBelief& belief) {
  Point best{0, -1};
  for (const Box& b : belief.boxes) {
    if (b.y_high > best.y) best = {b.x_low, b.y_high};
  }
  for (const Point& p : belief.points) {
    if (p.y > best.y) best = p;
  }
  return best;
}

/// The time of a belief above it, or as near to that as the map's edge allows.
std::string time_mark(const MapFrame& f, Point at, const std::string& time) {
  const double half = svg_width(time, 15) / 2 + 4;
  const double x = std::clamp(f.x(at.x), f.left + half, f.left + f.extent - half);
  return svg_text(x, std::max(f.y(at.y) - 6, f.top + 16), time, "time mid");
}

}  // namespace

std::string belief_marks(const MapFrame& f, const TraceBelief& belief) {
  std::string svg = svg_area(f, belief.boxes);
  double heaviest = 0;
  for (const double w : belief.weights) heaviest = std::max(heaviest, w);
  for (std::size_t k = 0; k < belief.points.size(); ++k) {
    const double share = heaviest > 0 ? belief.weights[k] / heaviest : 1;
    // The area shows the weight; what weighs next to nothing stays visible as a speck.
    svg += fmt::format("<circle class=\"particle\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>", svg_number(f.x(belief.points[k].x)),
                       svg_number(f.y(belief.points[k].y)), svg_number(std::max(1.2, 4.2 * std::sqrt(share))));
  }
  return svg;
}

std::string ball_mark(const MapFrame& f, Point truth, double eps) {
  return eps > 0 ? svg_box(f, {truth.x - eps, truth.x + eps, truth.y - eps, truth.y + eps}, "ball") : "";
}

std::string truth_mark(const MapFrame& f, Point at) {
  return fmt::format("<circle class=\"truth\" cx=\"{}\" cy=\"{}\" r=\"7\"/>", svg_number(f.x(at.x)),
                     svg_number(f.y(at.y)));
}

std::string shown_mark(const MapFrame& f, Point truth, Point shown) {
  if (shown == truth) return ring(f, shown, 10.5) + '\n';
  return fmt::format("<path class=\"tie\" d=\"M{}L{}\"/>{}", f.place(truth), f.place(shown), ring(f, shown, 6)) +
         fmt::format("<path class=\"shown\" d=\"M{}h8m-4 -4v8\"/>\n", svg_place(f.x(shown.x) - 4, f.y(shown.y)));
}

std::vector<long> moments(const EpisodeTrace& trace, int count) {
  std::vector<long> with;
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    if (!trace.steps[k].belief.empty()) with.push_back(static_cast<long>(k));
  }
  std::vector<long> kept;
  const std::size_t n = std::min(with.size(), static_cast<std::size_t>(std::max(0, count)));
  // From the first to the last, both included.
  for (std::size_t i = 0; i < n; ++i) kept.push_back(with[n == 1 ? 0 : i * (with.size() - 1) / (n - 1)]);
  return kept;
}

std::string path_picture(const EpisodeTrace& trace, const PathPictureOptions& options) {
  const MapFrame f{map_margin, title_room};
  const std::string title = options.title.empty() ? column_title({trace.attack, trace.eps}) : options.title;
  std::string svg = open_map(title_room + MapFrame::extent + 30, title,
                             fmt::format("{}, {}: {}", trace.agent, title, trace.outcome()));
  svg += svg_map(f);
  std::string times;
  for (const long k : options.belief_at) {
    if (k < 0 || k >= static_cast<long>(trace.steps.size())) continue;
    const TraceStep& s = trace.steps[static_cast<std::size_t>(k)];
    if (s.belief.empty()) continue;
    svg += fmt::format("<g><title>belief at t = {}</title>{}</g>\n", k, belief_marks(f, s.belief));
    times += time_mark(f, corner_of(s.belief), fmt::format("{}", k));
  }
  if (!trace.steps.empty()) {
    svg += true_path(f, trace, trace.steps.size(), true);
    if (options.shown) svg += shown_positions(f, trace);
    svg += fmt::format("<circle class=\"start\" cx=\"{}\" cy=\"{}\" r=\"6.5\"/>",
                       svg_number(f.x(trace.steps[0].truth.x)), svg_number(f.y(trace.steps[0].truth.y)));
    svg += truth_mark(f, trace.end) + times;
  }
  return svg + svg_text(map_margin, title_room + MapFrame::extent + 22, trace.outcome(), "outcome") + "</svg>\n";
}

std::string moment_picture(const EpisodeTrace& trace, long step) {
  const auto k = static_cast<std::size_t>(step);
  const TraceStep& s = trace.steps.at(k);
  const Point next = k + 1 < trace.steps.size() ? trace.steps[k + 1].truth : trace.end;
  const MapFrame f{map_margin, title_room};
  const std::string title = fmt::format("t = {}", step);
  std::string svg =
      open_map(title_room + MapFrame::extent + map_margin, title,
               fmt::format("{}, {} at t = {}: true position ({:.2f}, {:.2f}), shown ({:.2f}, {:.2f}), move {}",
                           trace.agent, trace.attack, step, s.truth.x, s.truth.y, s.shown.x, s.shown.y,
                           gridworld::moves[static_cast<std::size_t>(s.action)].name));
  svg += svg_map(f) + belief_marks(f, s.belief);
  if (k > 0) svg += true_path(f, trace, k + 1, false);
  svg += ball_mark(f, s.truth, trace.eps) + svg_move(f, s.truth, s.action, next == s.truth) + truth_mark(f, s.truth);
  return svg + shown_mark(f, s.truth, s.shown) + "</svg>\n";
}

std::string map_legend() {
  const auto key = [](const std::string& mark, const std::string& words) {
    return fmt::format("<li><svg class=\"map key\" viewBox=\"0 0 34 24\" aria-hidden=\"true\">{}</svg>{}</li>\n", mark,
                       words);
  };
  return "<ul class=\"legend\">\n" +
         key("<path class=\"path\" d=\"M2 12H22\"/><circle class=\"truth\" cx=\"24\" cy=\"12\" r=\"7\"/>",
             "true position and path; the ring is the start") +
         key("<path class=\"tie\" d=\"M4 18L22 10\"/><circle class=\"shown\" cx=\"22\" cy=\"10\" r=\"6\"/>",
             "what the attacker shows") +
         key("<rect class=\"ball\" x=\"6\" y=\"3\" width=\"20\" height=\"18\"/>", "what it may show (ε-ball)") +
         key("<rect class=\"belief\" x=\"4\" y=\"4\" width=\"26\" height=\"16\"/>",
             "what the agent holds possible, with its time") +
         key("<circle class=\"particle\" cx=\"8\" cy=\"9\" r=\"4\"/><circle class=\"particle\" cx=\"18\" cy=\"15\" "
             "r=\"3\"/><circle class=\"particle\" cx=\"26\" cy=\"8\" r=\"1.6\"/>",
             "particles, area by weight") +
         "</ul>\n";
}

std::string_view map_style() {
  // Blue, orange and green of Okabe and Ito's palette, told apart by people with any of the common colour deficiencies;
  // a disc, a ring and an area besides. Wall, gold and bomb are told apart by lightness and by signs.
  return R"css(
svg.map { --floor: #fbfbf9; --lines: #e8eaec; --wall: #59636e; --edge: #59636e; --text: #16191d; --quiet: #505a65;
  --gold: #ffe08a; --star: #8a6100; --danger: #d9c9d6; --bomb: #1d1a22; --truth: #0067a9; --shown: #c2410c;
  --belief: #009e73; --back: #ffffff;
  display: block; width: 100%; height: auto; }
@media (prefers-color-scheme: dark) {
  svg.map { --floor: #20262d; --lines: #2c343d; --wall: #8793a0; --edge: #8793a0; --text: #eceff2; --quiet: #a7b1bc;
    --gold: #6e5716; --star: #ffd75e; --danger: #50394f; --bomb: #e6dbe8; --truth: #5cb8f5; --shown: #ff9d5c;
    --belief: #2fd3a4; --back: #14171b; }
}
@media print {
  svg.map { --floor: #ffffff; --lines: #e3e6e8; --wall: #59636e; --edge: #59636e; --text: #000000; --quiet: #333333;
    --gold: #ffe08a; --star: #8a6100; --danger: #d9c9d6; --bomb: #1d1a22; --truth: #0067a9; --shown: #c2410c;
    --belief: #009e73; --back: #ffffff; }
}
svg.map.key { flex: none; width: 40px; height: 28px; }
svg.map text { font: 16px system-ui, "Segoe UI", "Helvetica Neue", "Liberation Sans", Arial, sans-serif; fill: var(--text);
  font-variant-numeric: tabular-nums; }
svg.map text.title { font-size: 18px; font-weight: 650; }
svg.map text.outcome, svg.map text.quiet { fill: var(--quiet); }
svg.map text.strong { font-weight: 650; }
svg.map text.mid { text-anchor: middle; }
svg.map text.end { text-anchor: end; }
svg.map text.time { font-size: 15px; font-weight: 650; fill: var(--belief); paint-order: stroke; stroke: var(--floor);
  stroke-width: 4px; stroke-linejoin: round; }
svg.map path { fill: none; stroke-linejoin: round; stroke-linecap: round; }
svg.map .floor { fill: var(--floor); }
svg.map .lines { stroke: var(--lines); stroke-width: 1; }
svg.map path.wall { fill: var(--wall); stroke: var(--wall); stroke-width: .6; }
svg.map .edge { fill: none; stroke: var(--edge); stroke-width: 2; }
svg.map .gold { fill: var(--gold); }
svg.map .star { fill: var(--star); }
svg.map .danger { fill: var(--danger); }
svg.map .bomb { fill: var(--bomb); }
svg.map .fuse { stroke: var(--bomb); stroke-width: 2.4; }
svg.map .spark { fill: var(--shown); }
svg.map .halo { stroke: var(--floor); stroke-width: 6.5; stroke-opacity: .75; }
svg.map .path { stroke: var(--truth); stroke-width: 3; }
svg.map .truth { fill: var(--truth); stroke: var(--floor); stroke-width: 2; }
svg.map .start { fill: var(--floor); stroke: var(--truth); stroke-width: 3; }
svg.map .shown { fill: none; stroke: var(--shown); stroke-width: 2.2; }
svg.map .tie { stroke: var(--shown); stroke-width: 1.4; stroke-dasharray: 3 3; }
svg.map .ball { fill: none; stroke: var(--shown); stroke-width: 1.5; stroke-dasharray: 5 4; }
svg.map path.area { fill: var(--belief); fill-opacity: .3; }
svg.map .area-edge { stroke: var(--belief); stroke-width: 2; }
svg.map .belief { fill: var(--belief); fill-opacity: .3; stroke: var(--belief); stroke-width: 1; stroke-opacity: .9; }
svg.map .particle { fill: var(--belief); fill-opacity: .55; stroke: var(--belief); stroke-width: .8; }
svg.map .move { stroke: var(--truth); stroke-width: 3; }
svg.map .backdrop { fill: var(--back); }
svg.map .track { fill: var(--lines); }
svg.map .fill { fill: var(--truth); }
)css";
}

std::string standalone_svg(std::string_view svg) {
  const std::size_t head = svg.find("<svg"), body = svg.find('>', head) + 1;
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\"{}\n<style>{}</style>\n{}",
                     svg.substr(head + 4, body - head - 4), map_style(), svg.substr(body));
}

}  // namespace maximin::deep
