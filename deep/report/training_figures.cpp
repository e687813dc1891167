#include <maximin/deep/report/training_figures.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/svg_plot.hpp>

namespace maximin::deep {
namespace {

constexpr std::size_t agents_per_picture = 7;  // as many as there are colours
constexpr int grid_points = 240;

struct Span {
  double low = INFINITY, high = -INFINITY;
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return !(low <= high); }
};

/// Lines of one agent: what the seeds that have a value there come to.
struct AgentLines {
  std::vector<report::Mark> mean, low, high;
  bool several = false;  ///< more than one seed somewhere
};

std::vector<std::string> agents_of(const std::vector<TrainingCurve>& curves) {
  std::vector<std::string> names;
  for (const TrainingCurve& c : curves) {
    if (std::find(names.begin(), names.end(), c.agent) == names.end()) names.push_back(c.agent);
  }
  return names;
}

Span frames_of(const std::vector<TrainingCurve>& curves) {
  Span span;
  for (const TrainingCurve& c : curves) {
    for (const auto& row : c.log.rows) span.take(*row.front());
  }
  return span;
}

AgentLines lines_of(const std::vector<TrainingCurve>& curves, const std::string& agent, std::string_view column,
                    const Span& frames) {
  AgentLines lines;
  for (int i = 0; i <= grid_points; ++i) {
    const double at = frames.low + (frames.high - frames.low) * i / grid_points;
    Span span;
    double sum = 0;
    int seeds = 0;
    for (const TrainingCurve& c : curves) {
      const auto index = c.log.column(column);
      const auto value = c.agent == agent && index ? value_at(c.log, *index, at) : std::nullopt;
      if (!value) continue;
      span.take(*value);
      sum += *value;
      ++seeds;
    }
    if (seeds == 0) continue;
    lines.mean.push_back({at, sum / seeds, ""});
    lines.low.push_back({at, span.low, ""});
    lines.high.push_back({at, span.high, ""});
    lines.several = lines.several || seeds > 1;
  }
  return lines;
}

struct Figure {
  std::string_view column, title;
  bool logarithmic;
};

report::Axis axis_of(const std::vector<AgentLines>& agents, bool logarithmic) {
  Span span;
  for (const AgentLines& a : agents) {
    for (const auto& m : a.low) span.take(m.y);
    for (const auto& m : a.high) span.take(m.y);
  }
  // A column that falls to zero has no logarithm everywhere: then the straight scale.
  return logarithmic && span.low > 0 ? report::Axis::logarithmic(span.low, span.high)
                                     : report::Axis::linear(span.low, span.high);
}

std::string picture(const std::vector<TrainingCurve>& curves, const std::vector<std::string>& agents,
                    const Figure& figure) {
  const Span frames = frames_of(curves);
  std::vector<AgentLines> all;
  bool any = false;
  for (const std::string& agent : agents) {
    all.push_back(lines_of(curves, agent, figure.column, frames));
    any = any || !all.back().mean.empty();
  }
  if (!any) return "";
  report::Frame frame;
  frame.width = 560;
  frame.title = figure.title;
  frame.description = fmt::format("{} over the frames of training", figure.title);
  // Millions, where there are any: the labels of the axis stay short.
  const double unit = frames.high >= 1e6 ? 1e6 : frames.high >= 1e4 ? 1e3 : 1;
  frame.x_label = unit == 1e6 ? "millions of frames" : unit == 1e3 ? "thousands of frames" : "frames";
  for (AgentLines& a : all) {
    for (auto* line : {&a.mean, &a.low, &a.high}) {
      for (report::Mark& m : *line) m.x /= unit;
    }
  }
  const auto x = report::Axis::linear(frames.low / unit, frames.high / unit, 5);
  report::Plot plot(frame, x, axis_of(all, figure.logarithmic));
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].several) plot.band(all[i].low, all[i].high, i);
  }
  for (std::size_t i = 0; i < all.size(); ++i) plot.line(all[i].mean, i);
  return "<figure>" + plot.svg() + "</figure>\n";
}

}  // namespace

std::optional<double> value_at(const TrainingLog& log, std::size_t column, double frames) {
  const std::vector<std::optional<double>>* before = nullptr;
  for (const auto& row : log.rows) {
    if (!row[column]) continue;
    if (*row.front() == frames) return row[column];
    if (*row.front() > frames) {
      if (!before) return std::nullopt;
      const double share = (frames - *before->front()) / (*row.front() - *before->front());
      return *(*before)[column] + share * (*row[column] - *(*before)[column]);
    }
    before = &row;
  }
  return std::nullopt;
}

std::string_view training_style() {
  return R"css(
svg.plot path.band { stroke: none; fill-opacity: .16; }
svg.plot .band.s0 { fill: var(--s0); } svg.plot .band.s1 { fill: var(--s1); } svg.plot .band.s2 { fill: var(--s2); }
svg.plot .band.s3 { fill: var(--s3); } svg.plot .band.s4 { fill: var(--s4); } svg.plot .band.s5 { fill: var(--s5); }
svg.plot .band.s6 { fill: var(--s6); }
)css";
}

std::string training_figures(const std::vector<TrainingCurve>& curves) {
  const std::vector<std::string> agents = agents_of(curves);
  std::string html;
  for (std::size_t from = 0; from < agents.size(); from += agents_per_picture) {
    const std::vector<std::string> some(
        agents.begin() + static_cast<std::ptrdiff_t>(from),
        agents.begin() + static_cast<std::ptrdiff_t>(std::min(agents.size(), from + agents_per_picture)));
    std::string pictures;
    for (const Figure& figure : {Figure{"return", "Return of the episodes", false}, Figure{"loss", "Loss", true},
                                 Figure{"exploration", "Share of random actions", false}}) {
      pictures += picture(curves, some, figure);
    }
    if (!pictures.empty()) html += "<div class=\"grid\">\n" + pictures + "</div>\n" + report::line_legend(some);
  }
  return html;
}

}  // namespace maximin::deep
