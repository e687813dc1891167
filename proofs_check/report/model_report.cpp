#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_report.hpp>
#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/page.hpp>
#include <maximin/proofs_check/report/svg_plot.hpp>
#include <maximin/proofs_check/verdict_text.hpp>

namespace maximin {
namespace {

using namespace report;
using Json = nlohmann::ordered_json;

bool checked(const Check& check) {
  return check.verdict == Verdict::holds || check.verdict == Verdict::violated;
}

/// Names of the claims that satisfy the condition.
template <class Condition>
std::string names_where(Condition condition) {
  std::string names;
  for (const Claim& c : claims()) {
    if (condition(c)) names += fmt::format("{}{}", names.empty() ? "" : ", ", escape(c.name));
  }
  return names;
}

std::string informative_sentence(const Examination& e) {
  const std::string telling = names_where([&](const Claim& c) { return c.is_bound && e.informative(c.id); });
  if (telling.empty())
    return "Every bound is vacuous here: at or above the trivial γ span(R)/(1-γ) it holds whatever is done.";
  return fmt::format("Informative, being below the trivial γ span(R)/(1-γ) = {}: {}.", number(e.trivial), telling);
}

std::string verdict(const Examination& e, bool exact, const std::string& doubt) {
  const auto with = [&](Verdict v) { return names_where([&](const Claim& c) { return e.check(c.id).verdict == v; }); };
  if (e.any(Verdict::violated)) {
    return verdict_box("bad", {"Violated on this model: " + with(Verdict::violated) + ".", informative_sentence(e)});
  }
  if (e.any(Verdict::assumption_fails)) {
    return verdict_box("warn", {"An assumption of the claims fails on this model, so they say nothing of it.",
                                escape(e.failed_assumption)});
  }
  const std::string open = with(Verdict::undetermined);
  if (!open.empty()) {
    return verdict_box("warn", {"Undetermined: a budget ran out before every claim was decided.",
                                "Open: " + open + ". No other claim is violated.", informative_sentence(e)});
  }
  const long n = std::count_if(e.checks.begin(), e.checks.end(), checked);
  if (n == 0) return verdict_box("warn", {"Nothing was checked on this model."});
  return verdict_box(
      doubt.empty() ? "" : "warn",
      {doubt, n == 1 ? "The claim holds on this model." : fmt::format("All {} claims hold on this model.", n),
       informative_sentence(e),
       exact ? "Proved in exact arithmetic, for this model alone."
             : "Checked in floating point with certified numerical error; no proof for other models."});
}

std::string claims_table(const Examination& e) {
  std::string rows;
  for (const Claim& c : claims()) {
    const Check& k = e.check(c.id);
    if (k.verdict == Verdict::not_asked) continue;
    const bool bad = k.verdict == Verdict::violated;
    const auto shown = [&](double x) { return checked(k) ? number(x) : std::string("-"); };
    const std::string worth = !c.is_bound || !checked(k) ? "" : e.informative(c.id) ? ", informative" : ", vacuous";
    const std::string tight = checked(k) && std::isfinite(k.tightness()) ? number(k.tightness()) : "-";
    rows += fmt::format(
        "<tbody class=\"claim\"><tr><td><b>{}</b> {}</td><td "
        "class=\"text{}\">{}{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td>{}</td></tr>\n<tr class=\"detail\"><td colspan=\"6\"><code>{}</code> ({}). {} checked.</td></tr>"
        "</tbody>\n",
        escape(c.name), escape(c.title), bad ? " bad-text" : "", to_string(k.verdict), worth, shown(k.left),
        shown(k.right), tight, k.n < 0 ? "-" : std::to_string(k.n), escape(c.statement), escape(c.reference),
        counted(k.instances, "instance", "instances"));
  }
  if (rows.empty()) return "";
  return "<h2>The claims</h2>\n<p>Both sides of every inequality, left ≤ right, at the round, pair of states and "
         "action "
         "where it comes closest to failing.</p>\n<div class=\"scroll\"><table><thead><tr><th>claim</th>"
         "<th style=\"text-align:left\">verdict</th><th>left side</th><th>right side</th><th>left / right</th>"
         "<th>at round n</th></tr></thead>\n" +
         rows + "</table></div>\n" + notation();
}

/// Both sides of the bounds (or of the steps of the argument) on one logarithmic axis.
std::string sides_figure(const Examination& e, bool bounds) {
  std::vector<Interval> rows;
  double low = std::numeric_limits<double>::infinity(), high = 0;
  bool zero = false;
  const auto take = [&](double v) {
    zero = zero || !(v > 0);
    if (v > 0) low = std::min(low, v), high = std::max(high, v);
  };
  for (const Claim& c : claims()) {
    const Check& k = e.check(c.id);
    if (c.is_bound != bounds || !checked(k) || !std::isfinite(k.left) || !std::isfinite(k.right)) continue;
    const double left = k.left <= k.slack ? 0 : k.left;
    take(left);
    take(k.right);
    const std::string name = c.name.size() <= 2 ? fmt::format("{}: {}", c.name, c.title) : std::string(c.title);
    const Role role = k.verdict == Verdict::violated   ? Role::violated
                      : !bounds || e.informative(c.id) ? Role::highlighted
                                                       : Role::plain;
    rows.push_back({name, left, k.right,
                    fmt::format("({} {} {})", number(left), role == Role::violated ? ">" : "≤", number(k.right)),
                    role});
  }
  if (rows.empty()) return "";
  if (bounds && e.trivial > 0) take(e.trivial);
  Frame frame;
  frame.width = 760;
  frame.description = bounds ? "gap and bound of every bound" : "left and right side of every step of the argument";
  frame.x_label = bounds ? "loss, in units of reward" : "difference, in units of reward";
  const double foot = high > 0 ? std::max(low, high * 1e-6) : 1;
  const Axis axis = Axis::logarithmic(foot, std::max(high, foot), zero || low < foot);
  const double rule = bounds && e.trivial > 0 ? e.trivial : std::numeric_limits<double>::quiet_NaN();
  return interval_chart(frame, rows, axis, rule, "trivial bound");
}

std::string sides_section(const Examination& e) {
  std::string html;
  const std::string bounds = sides_figure(e, true);
  if (!bounds.empty()) {
    html +=
        "<h2>Gap against bound</h2>\n<figure><figcaption>The dot is the gap that was measured, the bar what the bound "
        "allows. <b>See</b> how much room there is between them, and which bars stand left of the trivial bound: those "
        "bounds say something, and are drawn in blue; grey ones are vacuous. Tick 0 is no gap beyond the numerical "
        "error.</figcaption>\n<div class=\"wide\">" +
        bounds + "</div></figure>\n";
  }
  const std::string steps = sides_figure(e, false);
  if (!steps.empty()) {
    html +=
        "<h3>The steps of the argument</h3>\n<figure><figcaption>The same for the lemmas.</figcaption>\n"
        "<div class=\"wide\">" +
        steps + "</div></figure>\n";
  }
  return html;
}

std::vector<Mark> curve(const std::vector<double>& values) {
  constexpr std::size_t most_points = 400;
  std::vector<Mark> points;
  for (const std::size_t n : thinned(values.size(), most_points)) {
    if (std::isfinite(values[n])) points.push_back({static_cast<double>(n), values[n], ""});
  }
  return points;
}

std::string rounds_section(const Examination& e, const RoundSeries& rounds) {
  if (rounds.gap.empty()) return "";
  double low = std::numeric_limits<double>::infinity(), high = e.trivial > 0 ? e.trivial : 0;
  bool zero = false;
  const auto take = [&](const std::vector<double>& values) {
    for (const double v : values) {
      if (!std::isfinite(v)) continue;
      zero = zero || v <= 0;
      if (v > 0) low = std::min(low, v), high = std::max(high, v);
    }
  };
  take(rounds.gap);
  std::vector<std::string> names{"gap: max (Q* - Q^{pi_n, best attack})"};
  for (const auto& [id, values] : rounds.bounds) {
    take(values);
    names.push_back(fmt::format("bound {}: {}", claim(id).name, claim(id).title));
  }
  const double foot = high > 0 ? std::max(std::min(low, high), high * 1e-6) : 1;
  Frame frame;
  frame.width = 760;
  frame.height = 420;
  frame.description = "gap and bounds at every round of pessimistic Q-iteration";
  frame.x_label = "round n of pessimistic Q-iteration";
  frame.y_label = "loss, in units of reward";
  Plot plot(frame, Axis::linear(0, static_cast<double>(std::max<std::size_t>(rounds.gap.size() - 1, 1)), 6),
            Axis::logarithmic(foot, std::max(high, foot), zero || low < foot));
  if (e.trivial > 0) plot.horizontal(e.trivial, "trivial bound");
  plot.line(curve(rounds.gap), 0);
  for (std::size_t b = 0; b < rounds.bounds.size(); ++b) plot.line(curve(rounds.bounds[b].second), b + 1);
  return "<h2>Round by round</h2>\n<figure><figcaption>The loss of the policy of each round against its optimal "
         "attacker, "
         "and what the bounds for finite n allow. <b>See</b> how far above it they run, how they approach their "
         "limits like γ^n, and whether they get below the trivial bound.</figcaption>\n<div class=\"wide\">" +
         plot.svg() + line_legend(names) + "</div></figure>\n";
}

std::string fate_of(const Examination& e) {
  if (e.fate == Fate::settled) return fmt::format("settled after {} rounds", count(e.iterations));
  if (e.fate == Fate::cycles)
    return fmt::format("cycles with period {}, seen after {} rounds", e.period, count(e.iterations));
  return fmt::format("neither settled nor cycled in {} rounds", count(e.iterations));
}

std::string model_facts(const Examination& e) {
  const auto yes = [](bool b) { return std::string(b ? "yes" : "no"); };
  return "<h2>The model</h2>\n" +
         facts({{"states, actions", fmt::format("{}, {}", count(e.states), count(e.actions))},
                {"discount γ", number(e.discount)},
                {"eps", number(e.eps)},
                {"largest distance inside a ball", number(e.radius)},
                {"states in the largest ball", count(e.largest_ball)},
                {"l_r, Lipschitz constant of R", number(e.constants.l_r.value)},
                {"l_p, Lipschitz constant of P", number(e.constants.l_p.value)},
                {"K, the same in total variation", number(e.constants.k_tv.value)},
                {"R", fmt::format("from {} to {}", number(e.constants.r_min), number(e.constants.r_max_signed))},
                {"L*, Lipschitz constant of Q*", number(e.lipschitz_of_q_star)},
                {"γ span(R)/(1-γ), the trivial bound", number(e.trivial)},
                {"pessimistic Q-iteration", fate_of(e)},
                {"policy pairs met", count(e.pairs)},
                {"limsup of the gap", e.fate == Fate::undetermined ? "unknown" : number(e.gap)},
                {"the attack changes an action", yes(e.attack_changes_action)},
                {"pessimism changes an action", yes(e.pessimism_changes_action)},
                {"reachable (state, belief) pairs", count(e.belief_positions)}});
}

}  // namespace

std::string html_report(const Json& configuration, const TrialRecord& record, const RoundSeries& rounds) {
  const Examination& e = record.found;
  const std::string title = "What pessimism costs on " + (record.family.empty() ? "one model" : record.family);
  std::string body =
      fmt::format("<h1>{}</h1>\n<p class=\"sub\">{} states, {} actions, γ = {}, eps = {}; {}.</p>\n", escape(title),
                  count(e.states), count(e.actions), number(e.discount), number(e.eps), reading_of(configuration));
  body += verdict(e, is_exact(configuration), doubt_of(configuration)) + sides_section(e) + rounds_section(e, rounds) +
          claims_table(e) + model_facts(e);
  return page(title, body + configuration_section(configuration));
}

}  // namespace maximin
