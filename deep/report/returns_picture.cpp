#include <maximin/deep/report/returns_picture.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <maximin/deep/report/intervals_in_words.hpp>
#include <maximin/deep/report/results_text.hpp>
#include <maximin/deep/report/svg_canvas.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/svg_axis.hpp>

namespace maximin::deep {
namespace {

constexpr double picture_width = 560, row_height = 36, top_room = 34, axis_room = 42;

/// The ends of a block's scale: all that its pictures show, so that they can be compared with each other.
report::Axis scale_of(const ResultBlock& block) {
  double low = 0, high = 0;
  const auto take = [&](double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  };
  for (const ResultCell& c : block.cells) {
    if (c.paper) take(c.paper->mean);
    if (c.target) take(c.target->value);
    if (c.runs.empty()) continue;
    const Estimate e = estimate(c.runs);
    for (const double m : e.seed_means) take(m);
  }
  // An interval of three seeds may reach far beyond what a return can be: it is cut at the edge, with an arrow.
  const double room = 0.15 * (high - low);
  return report::Axis::linear(low - room, high + room, 6);
}

struct Row {
  double left, right, middle;  ///< of the plotting area, and its own height
  const report::Axis& axis;
  double x(double v) const { return left + (right - left) * axis.at(v); }
};

std::string interval_mark(const Row& row, double mean, const ConfidenceInterval& interval, bool across) {
  const double low = mean - interval.half_width, high = mean + interval.half_width;
  std::string d = fmt::format("M{}H{}", svg_place(row.x(low), row.middle), svg_number(row.x(high)));
  const auto end = [&](double v, int direction) {
    const bool cut = direction < 0 ? v < row.axis.low() : v > row.axis.high();
    return cut ? fmt::format("M{}L{}L{}", svg_place(row.x(v) - 7 * direction, row.middle - 5),
                             svg_place(row.x(v), row.middle), svg_place(row.x(v) - 7 * direction, row.middle + 5))
               : fmt::format("M{}v12", svg_place(row.x(v), row.middle - 6));
  };
  d += end(low, -1) + end(high, 1);
  return fmt::format("<path class=\"span{}\" d=\"{}\"/>", across ? "" : " narrow", d);
}

std::string marks_of(const Row& row, const ResultCell& c) {
  std::string svg;
  if (c.target) {
    svg += fmt::format("<path class=\"target\" d=\"M{}v22\"/>", svg_place(row.x(c.target->value), row.middle - 11));
  }
  if (c.paper) {
    const double x = row.x(c.paper->mean);
    svg += fmt::format("<path class=\"paper-mark\" d=\"M{}l6 6l-6 6l-6 -6z\"/>", svg_place(x, row.middle - 6));
  }
  if (c.runs.empty()) return svg;
  const Estimate e = estimate(c.runs);
  if (const auto shown = e.shown()) svg += interval_mark(row, e.mean, *shown, e.across_seeds.has_value());
  for (const double m : e.seed_means) {
    svg += fmt::format("<circle class=\"seed\" cx=\"{}\" cy=\"{}\" r=\"3.4\"/>", svg_number(row.x(m)),
                       svg_number(row.middle));
  }
  return svg + fmt::format("<path class=\"mean\" d=\"M{}v18\"/>", svg_place(row.x(e.mean), row.middle - 9));
}

std::string hover_of(const ResultCell& c) {
  std::string text = fmt::format("{}: {}", c.agent, cell_text(c));
  if (c.paper) text += "; paper " + paper_text(*c.paper);
  const std::string word = verdict_word(verdict(c));
  return word.empty() ? text : text + "; " + word;
}

std::string row_of(const Row& row, const ResultCell& c) {
  const TargetVerdict v = verdict(c);
  const bool miss = v == TargetVerdict::missed || v == TargetVerdict::missed_nearly;
  std::string svg =
      fmt::format("<g class=\"returns{}\"><title>{}</title>", miss ? " miss" : "", report::escape(hover_of(c)));
  svg += svg_text(row.left - 10, row.middle + 5, c.agent, "end");
  svg += fmt::format("<path class=\"grid\" d=\"M{}H{}\"/>", svg_place(row.left, row.middle), svg_number(row.right));
  svg += marks_of(row, c);
  if (c.runs.empty()) svg += svg_text(row.left + 8, row.middle + 5, "not run", "note");
  if (miss) svg += svg_text(row.right + 8, row.middle + 5, "miss", "miss-word");
  return svg + "</g>\n";
}

std::string returns_picture(const ResultBlock& block, const ResultBlock::Column& column, const report::Axis& axis) {
  std::vector<const ResultCell*> cells;
  double widest = 0;
  bool any = false;
  for (const std::string& agent : block.agents()) {
    const ResultCell* c = block.find(agent, column.attack, column.eps);
    if (!c) continue;
    any = any || !c->runs.empty();
    cells.push_back(c);
    widest = std::max(widest, svg_width(agent, 15));
  }
  if (!any) return "";
  const double left = std::min(widest + 18, 0.45 * picture_width), right = picture_width - 46;
  const double bottom = top_room + row_height * static_cast<double>(cells.size());
  const std::string title = column_title(column);
  std::string svg =
      fmt::format("<figure><svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", picture_width,
                  svg_number(bottom + axis_room), report::escape("Returns under " + title));
  svg += svg_text(4, 17, title, "title");
  for (const report::Tick& t : axis.ticks()) {
    const double x = left + (right - left) * axis.at(t.value);
    svg += fmt::format("<path class=\"{}\" d=\"M{}V{}\"/>\n", t.value == 0 ? "axis" : "grid", svg_place(x, top_room),
                       svg_number(bottom));
    svg += svg_text(x, bottom + 20, t.label, "mid");
  }
  double middle = top_room + row_height / 2;
  for (const ResultCell* c : cells) {
    svg += row_of({left, right, middle, axis}, *c);
    middle += row_height;
  }
  return svg + svg_text((left + right) / 2, bottom + 38, "return", "mid label") + "</svg></figure>\n";
}

std::string key(const std::string& mark, const std::string& words) {
  return fmt::format(
      "<li><svg class=\"plot key\" viewBox=\"0 0 44 16\" aria-hidden=\"true\"><g "
      "class=\"returns\">{}</g></svg>{}</li>\n",
      mark, words);
}

}  // namespace

std::string_view returns_style() {
  return R"css(
svg.plot .returns .span { stroke: var(--good); stroke-width: 2.4; }
svg.plot .returns .span.narrow { stroke-dasharray: 4 3; }
svg.plot .returns .mean { stroke: var(--good); stroke-width: 4.5; }
svg.plot .returns .seed { fill: var(--paper); stroke: var(--good); stroke-width: 1.5; }
svg.plot .returns .paper-mark { stroke: var(--s5); stroke-width: 2; fill: var(--paper); }
svg.plot .returns .target { stroke: var(--ink); stroke-width: 2; stroke-dasharray: 3 2.5; }
svg.plot .returns.miss .span, svg.plot .returns.miss .mean, svg.plot .returns.miss .seed { stroke: var(--bad); }
svg.plot text.miss-word { fill: var(--bad); font-weight: 650; }
)css";
}

std::string returns_pictures(const ResultBlock& block) {
  const report::Axis axis = scale_of(block);
  std::string pictures;
  for (const ResultBlock::Column& column : block.columns()) pictures += returns_picture(block, column, axis);
  if (pictures.empty()) return "";
  return "<div class=\"grid\">\n" + pictures + "</div>\n<ul class=\"legend\">\n" +
         key("<path class=\"span\" d=\"M3 8H41M3 2v12M41 2v12\"/><path class=\"mean\" d=\"M22 0v16\"/>",
             "mean with its 95% interval across seeds (dashed: of these networks alone; an arrow: it goes on)") +
         key("<circle class=\"seed\" cx=\"22\" cy=\"8\" r=\"4\"/>", "mean of one training seed") +
         key("<path class=\"paper-mark\" d=\"M22 2l6 6l-6 6l-6 -6z\"/>", "the paper's figure") +
         key("<path class=\"target\" d=\"M22 0v16\"/>", "target") + "</ul>\n";
}

}  // namespace maximin::deep
