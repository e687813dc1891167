#include <maximin/proofs_check/report/campaign_figures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_text.hpp>

namespace maximin::report {
namespace {

bool checked(const Check& check) {
  return check.verdict == Verdict::holds || check.verdict == Verdict::violated;
}

/// The left side, or 0 where it cannot be told from 0.
double left_above_slack(const Check& check) {
  return check.left <= check.slack ? 0 : check.left;
}

/// Smallest and largest positive value seen, and whether there were others.
struct LogRange {
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  bool zero = false;

  void take(double v) {
    if (!(v > 0)) {
      zero = true;
      return;
    }
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

void take(const std::vector<Mark>& marks, LogRange& x, LogRange& y) {
  for (const Mark& m : marks) {
    x.take(m.x);
    y.take(m.y);
  }
}

std::vector<Mark> drawn(const std::vector<Mark>& all, std::size_t cap) {
  std::vector<Mark> some;
  for (const std::size_t i : thinned(all.size(), cap)) some.push_back(all[i]);
  return some;
}

std::string figure(std::string_view caption, std::string_view pictures, std::string_view css_class) {
  return fmt::format("<figure>\n<figcaption>{}</figcaption>\n<div class=\"{}\">\n{}</div>\n</figure>\n", caption,
                     css_class, pictures);
}

std::string panel_title(const Claim& c) {
  return c.name.size() <= 2 ? fmt::format("{}: {}", c.name, c.title) : std::string(c.title);
}

/// Whether any record has a verdict on the claim.
bool any_checked(const Records& records, ClaimId id) {
  return std::any_of(records.begin(), records.end(), [&](const TrialRecord& r) { return checked(r.found.check(id)); });
}

std::string left_out(const GapAgainstBound& data) {
  std::string text;
  if (data.no_span > 0) text += fmt::format("; {} with constant rewards left out", count(data.no_span));
  if (data.not_finite > 0) {
    text += fmt::format("; <span class=\"bad-text\">{} with a side that is not finite left out</span>",
                        count(data.not_finite));
  }
  const std::size_t marks = std::min(data.informative.size(), most_marks);
  const std::size_t specks = std::min(data.vacuous.size(), most_specks);
  if (marks + specks < data.informative.size() + data.vacuous.size()) {
    text += fmt::format("; {} of them drawn, evenly spread over the trials", count(static_cast<long>(marks + specks)));
  }
  return text;
}

/// Up to so many vacuous points have hover text too.
constexpr std::size_t few = 150;

std::string scatter_panel(const Claim& c, const GapAgainstBound& data, const Axis& x, const Axis& y) {
  Frame frame;
  frame.title = panel_title(c);
  frame.description = fmt::format("{}: gap against bound on {} models", c.title, data.size());
  frame.x_label = "bound / trivial bound";
  frame.y_label = "gap / trivial bound";
  Plot plot(frame, x, y);
  plot.region_left_of(1, "informative");
  plot.vertical(1, "vacuous");
  plot.diagonal("gap = bound");
  if (data.vacuous.size() <= few) {
    plot.marks(data.vacuous, Role::plain);
  } else {
    plot.specks(drawn(data.vacuous, most_specks), Role::plain);
  }
  plot.marks(drawn(data.informative, most_marks), Role::highlighted);
  plot.marks(drawn(data.violated, most_violations), Role::violated);
  const auto n = static_cast<long>(data.size());
  std::string note = fmt::format("{}, informative on {} ({})", counted(n, "model", "models"),
                                 count(static_cast<long>(data.informative.size())),
                                 percent(static_cast<long>(data.informative.size()), n));
  if (!data.violated.empty()) {
    note +=
        fmt::format(", <span class=\"bad-text\">violated on {}</span>", count(static_cast<long>(data.violated.size())));
  }
  return fmt::format("<div>{}<figcaption>{}{}</figcaption></div>\n", plot.svg(), note, left_out(data));
}

std::string how_to_read_scatter(bool zero_gaps, bool violations, bool strays) {
  std::string html = R"(<div class="reading"><h3>How to read these</h3>
<div class="key-row"><svg class="plot" viewBox="0 0 30 28" aria-hidden="true"><g class="marks good"><circle cx="15" cy="14" r="6"/></g></svg>
<span>a model on which the bound says something: it is below γ span(R)/(1-γ), the trivial bound</span></div>
<div class="key-row"><svg class="plot" viewBox="0 0 30 28" aria-hidden="true"><path class="specks plain" style="stroke-width:12" d="M15 14h0"/></svg>
<span>a model on which it is vacuous: true, and useless</span></div>
)";
  if (zero_gaps) {
    html +=
        R"(<div class="key-row"><svg class="plot" viewBox="0 0 30 28" aria-hidden="true"><g class="marks good"><path style="stroke-width:3" d="M11 5v18M19 5v18"/></g></svg>
<span>an upright stroke at the foot: no gap beyond the certified numerical error, or one too small for this axis</span></div>
)";
  }
  if (violations) {
    html +=
        R"(<div class="key-row"><svg class="plot" viewBox="0 0 30 28" aria-hidden="true"><g class="marks bad"><path d="M8 7l14 14m0-14l-14 14"/></g></svg>
<span>a red cross: the claim is violated</span></div>
)";
  }
  if (strays) {
    html +=
        "<p>A bound for every n is drawn at its tightest round; a blue dot right of the line is informative in another "
        "one.</p>\n";
  }
  return html +
         "<p>The closer to the diagonal, the tighter. Rest the pointer on a blue mark for its trial.</p></div>\n";
}

/// Whether a point is informative in another round than the one that is drawn.
bool right_of_the_line(const std::vector<Mark>& informative) {
  return std::any_of(informative.begin(), informative.end(), [](const Mark& m) { return m.x >= 1; });
}

/// Where the bins of one axis of a heat map lie.
class Binning {
 public:
  /// Few distinct values get a bin each; others round edges, logarithmic when they span more than a factor of 20.
  explicit Binning(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const bool zero = !values.empty() && values.front() <= 0;
    std::vector<double> distinct = values;
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    if (distinct.size() <= 6) {
      bins_.at_edges = false;
      at_ = distinct;
      for (const double v : distinct) bins_.labels.push_back(fmt::format("{:.2g}", v));
      return;
    }
    const double least = zero ? *std::upper_bound(values.begin(), values.end(), 0.0) : values.front();
    const bool wide = values.back() > 20 * least && least > 0;
    const Axis axis = wide ? Axis::logarithmic(std::max(least, values.back() * 1e-6), values.back())
                           : Axis::linear(values.front(), values.back());
    for (const Tick& t : axis.ticks()) {
      at_.push_back(t.value);
      bins_.labels.push_back(t.label);
    }
    if (wide && (zero || least < at_.front())) {
      at_.insert(at_.begin(), 0);
      bins_.labels.insert(bins_.labels.begin(), "0");
    }
  }

  const Bins& bins() const { return bins_; }

  std::size_t of(double value) const {
    const auto above = static_cast<std::size_t>(std::upper_bound(at_.begin(), at_.end(), value) - at_.begin());
    return std::min(above == 0 ? 0 : above - 1, bins_.size() - 1);
  }

 private:
  Bins bins_;
  std::vector<double> at_;
};

/// eps in units of the distance span(R)/l_r, over which the rewards can run through their whole range.
double relative_eps(const Examination& e) {
  return e.constants.span > 0 ? e.radius * e.constants.l_r.value / e.constants.span : 0;
}

bool on_the_map(const Examination& e) {
  return std::isfinite(relative_eps(e)) && std::isfinite(e.discount);
}

std::string map_panel(const Claim& c, const Records& records, const Binning& x, const Binning& y) {
  std::vector<std::vector<Cell>> cells(y.bins().size(), std::vector<Cell>(x.bins().size()));
  for (const TrialRecord& r : records) {
    if (!checked(r.found.check(c.id)) || !on_the_map(r.found)) continue;
    Cell& cell = cells[y.of(r.found.discount)][x.of(relative_eps(r.found))];
    ++cell.whole;
    cell.part += r.found.informative(c.id);
  }
  Frame frame;
  frame.height = 350;
  frame.title = panel_title(c);
  frame.description =
      fmt::format("{}: share of the models on which the bound is informative, over eps and gamma", c.title);
  frame.x_label = "eps · l_r / span(R)";
  frame.y_label = "discount γ";
  return heat_map(frame, x.bins(), y.bins(), cells);
}

/// One curve per claim that has a ratio anywhere.
std::string tightness_plot(const Records& records, bool bounds, double height) {
  constexpr std::size_t most_steps = 240;
  std::vector<std::string> names;
  std::vector<std::vector<double>> samples;
  LogRange range;
  for (const Claim& c : claims()) {
    if (c.is_bound != bounds) continue;
    std::vector<double> sample = tightness_of(records, c.id);
    if (sample.empty()) continue;
    for (const double v : sample) range.take(v);
    const double median = sample[(sample.size() - 1) / 2];
    names.push_back(fmt::format("{}: median {}", panel_title(c), number(median)));
    samples.push_back(std::move(sample));
  }
  if (samples.empty()) return "";
  Frame frame;
  frame.width = 760;
  frame.height = height;
  frame.description = "distribution of left side / right side for each claim";
  frame.x_label = bounds ? "gap / bound" : "left side / right side";
  frame.y_label = "% of models up to here";
  const double high = std::max(1.0, range.high);
  const double low = std::max(std::min(range.low, 0.1), high * 1e-6);
  Plot plot(frame, Axis::logarithmic(low, high, range.zero || range.low < low), Axis::linear(0, 100, 4));
  plot.vertical(1, "attained");
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const auto& sample = samples[s];
    const double n = static_cast<double>(sample.size());
    std::vector<Mark> steps{{sample.front(), 0, ""}};
    for (const std::size_t i : thinned(sample.size(), most_steps)) {
      steps.push_back({sample[i], 100 * static_cast<double>(i + 1) / n, ""});
    }
    steps.push_back({sample.back(), 100, ""});
    steps.push_back({high, 100, ""});
    plot.stairs(steps, s);
  }
  return plot.svg() + line_legend(names);
}

std::vector<Bar> fate_bars(const CampaignSummary& s) {
  constexpr long longest_shown = 8;
  const auto bar = [&](std::string label, long n, Role role) {
    return Bar{std::move(label), static_cast<double>(n), fmt::format("{} ({})", count(n), percent(n, s.trials)), role};
  };
  std::vector<Bar> bars{bar("settles: one policy pair for ever", s.settled, Role::plain)};
  long longer = 0;
  for (const auto& [period, trials] : s.periods) {
    if (period > longest_shown) {
      longer += trials;
    } else {
      bars.push_back(bar(fmt::format("cycles with period {}", period), trials, Role::highlighted));
    }
  }
  if (s.periods.empty()) bars.push_back(bar("cycles", 0, Role::highlighted));
  if (longer > 0) bars.push_back(bar("cycles with a longer period", longer, Role::highlighted));
  if (s.fate_undetermined > 0)
    bars.push_back(bar("neither within the rounds allowed", s.fate_undetermined, Role::violated));
  return bars;
}

std::vector<Bar> regime_bars(const CampaignSummary& s) {
  const auto bar = [&](const char* label, long n) {
    return Bar{label, static_cast<double>(n), fmt::format("{} ({})", count(n), percent(n, s.trials)),
               Role::highlighted};
  };
  return {bar("a ball holds more than one state", s.balls_of_several),
          bar("the attack changes an action", s.attack_changes_action),
          bar("pessimism changes an action", s.pessimism_changes_action), bar("the policy pair cycles", s.cycles),
          bar("at least one bound is informative", s.any_informative)};
}

}  // namespace

GapAgainstBound gap_against_bound(const Records& records, ClaimId id) {
  GapAgainstBound data;
  for (const TrialRecord& r : records) {
    const Check& check = r.found.check(id);
    if (!checked(check)) continue;
    const double trivial = r.found.trivial;
    if (!std::isfinite(check.left) || !std::isfinite(check.right) || !std::isfinite(trivial)) {
      ++data.not_finite;
    } else if (!(trivial > 0)) {
      ++data.no_span;
    } else {
      Mark mark{check.right / trivial, left_above_slack(check) / trivial,
                fmt::format("trial {}: gap {}, bound {}", r.trial, number(check.left), number(check.right))};
      auto& group = check.verdict == Verdict::violated ? data.violated
                    : r.found.informative(id)          ? data.informative
                                                       : data.vacuous;
      group.push_back(std::move(mark));
    }
  }
  return data;
}

std::vector<double> tightness_of(const Records& records, ClaimId id) {
  std::vector<double> ratios;
  for (const TrialRecord& r : records) {
    const Check& check = r.found.check(id);
    if (checked(check) && std::isfinite(check.tightness())) ratios.push_back(check.tightness());
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

std::string scatter_figure(const Records& records) {
  std::vector<std::pair<Claim, GapAgainstBound>> panels;
  LogRange x, y;
  bool violations = false, strays = false;
  for (const Claim& c : claims()) {
    if (!c.is_bound) continue;
    GapAgainstBound data = gap_against_bound(records, c.id);
    if (data.size() + static_cast<std::size_t>(data.no_span + data.not_finite) == 0) continue;
    for (const auto* group : {&data.informative, &data.vacuous, &data.violated}) take(*group, x, y);
    violations = violations || !data.violated.empty();
    strays = strays || right_of_the_line(data.informative);
    panels.emplace_back(c, std::move(data));
  }
  if (panels.empty()) return "";
  // Both axes are common to all panels, and reach the trivial bound even where no point does.
  const Axis x_axis = Axis::logarithmic(std::min(x.low, 0.05), std::max(x.high, 1.0), x.zero);
  const double top = std::max(y.high, 1.0);
  const Axis y_axis =
      Axis::logarithmic(std::max(std::min(y.low, 0.001), top * 1e-6), top, y.zero || y.low < top * 1e-6);
  std::string pictures;
  for (const auto& [c, data] : panels) pictures += scatter_panel(c, data, x_axis, y_axis);
  pictures += how_to_read_scatter(y.zero, violations, strays);
  const std::string see = violations ? "the red crosses above the diagonal, where a gap exceeds its bound"
                                     : "that no point lies above the diagonal, and how far below it most lie";
  return figure(
      "Each point is one model. Across: what the bound allows. Up: the gap that was measured. Both are divided by the "
      "trivial bound γ span(R)/(1-γ), so that models of every size share one picture. <b>See</b> " +
          see + "; and which models lie in the tinted region, where the bound says something.",
      pictures, "grid");
}

std::string tightness_figure(const Records& records) {
  if (records.size() < 2) return "";
  std::string html;
  const std::string bounds = tightness_plot(records, true, 400);
  if (!bounds.empty()) {
    html += figure(
        "<b>See</b> which curve climbs furthest to the right: that bound is the tightest, its gaps come closest to "
        "what "
        "it allows. What a curve climbs at 0 is the share of the models with no gap, or one too small for this axis. "
        "Vacuous instances are included; each model counts once, at its tightest round.",
        bounds, "wide");
  }
  const std::string steps = tightness_plot(records, false, 320);
  if (!steps.empty()) {
    html += "<h3>The steps of the argument</h3>\n" +
            figure("The same for the lemmas, which are inequalities between tables and not bounds on a loss.", steps,
                   "wide");
  }
  return html;
}

std::string informativeness_figure(const Records& records) {
  if (records.size() < 2) return "";
  std::vector<double> eps, gamma;
  for (const TrialRecord& r : records) {
    const bool any = std::any_of(claims().begin(), claims().end(),
                                 [&](const Claim& c) { return c.is_bound && checked(r.found.check(c.id)); });
    if (!any || !on_the_map(r.found)) continue;
    eps.push_back(relative_eps(r.found));
    gamma.push_back(r.found.discount);
  }
  if (eps.empty()) return "";
  const Binning x(std::move(eps)), y(std::move(gamma));
  std::string pictures;
  for (const Claim& c : claims()) {
    if (c.is_bound && any_checked(records, c.id)) pictures += map_panel(c, records, x, y);
  }
  return figure(
      "The number in a cell is the percentage of its models on which the bound lies below the trivial one; a dashed "
      "cell "
      "had no model. Across: how much of the range of the rewards one perturbation can cross. Up: the discount. "
      "<b>See</b> how far to the right and up the filled cells reach, if there are any: there a bound is worth "
      "quoting.",
      pictures, "grid");
}

std::string fate_and_regime_figure(const CampaignSummary& s) {
  if (s.trials == 0) return "";
  Frame fate;
  fate.title = "What became of the policies";
  fate.description = "how many trials settled, or cycled with which period";
  Frame regimes;
  regimes.title = "What the campaign covered";
  regimes.description = "on how many trials each regime occurred";
  const double full = static_cast<double>(s.trials);
  std::string pictures = "<div>" + bar_chart(fate, fate_bars(s), full) + "</div>\n<div>" +
                         bar_chart(regimes, regime_bars(s), full) + "</div>\n";
  if (s.families.size() > 1) {
    std::vector<Bar> bars;
    for (const auto& [family, n] : s.families) {
      bars.push_back(
          {family, static_cast<double>(n), fmt::format("{} ({})", count(n), percent(n, s.trials)), Role::plain});
    }
    Frame families;
    families.title = "Where the models came from";
    families.description = "number of trials of each family of random models";
    pictures += "<div>" + bar_chart(families, bars, full) + "</div>\n";
  }
  return figure(
      fmt::format("Counted over {}. Pessimistic Q-iteration need not converge: <b>see</b> how many models cycle "
                  "for ever, and how many have an attack and a pessimism that change what is done.",
                  counted(s.trials, "trial", "trials")),
      pictures, "grid");
}

}  // namespace maximin::report
