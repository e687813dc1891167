#include <maximin/proofs_check/verdict_text.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace maximin {
namespace {

std::string percent(long part, long whole) {
  if (whole == 0) return "-";
  return fmt::format("{:.1f}%", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string ratio(double x) {
  return std::isfinite(x) ? fmt::format("{:.4f}", x) : "-";
}

std::string reading_text(Reading reading) {
  return reading == Reading::paper ? "as the paper prints it: R_max = max(0, max R)" : "corrected: R_max = max |R|";
}

std::string claim_row(const Claim& claim, const ClaimSummary& s) {
  const std::string informative = claim.is_bound ? percent(s.informative, s.checked()) : "";
  const std::string tight = s.max_trial < 0 ? fmt::format("{:>8} {:>8} {:>8} {:>8}", "-", "-", "-", "-")
                                            : fmt::format("{:>8} {:>8} {:>8} {:>8}", ratio(s.median), ratio(s.p99),
                                                          ratio(s.max), s.max_trial);
  return fmt::format("  {:<16} {:<32} {:>7} {:>8} {:>8} {:>11}  {}\n", claim.name, claim.title, s.checked(), s.violated,
                     s.undetermined, informative, tight);
}

std::string periods(const CampaignSummary& s) {
  std::string text;
  for (const auto& [period, trials] : s.periods) {
    text += fmt::format("{}period {}: {}", text.empty() ? " (" : ", ", period, trials);
  }
  return text.empty() ? text : text + ")";
}

std::string conclusion(const CampaignSummary& s, std::uint64_t seed, bool complete) {
  const char* interrupted = complete ? "" : " The run was interrupted; --resume completes it.";
  switch (exit_code(s, complete)) {
    case ExitCode::violated: {
      std::string lines;
      for (const Claim& c : claims()) {
        const ClaimSummary& cs = s.claims[static_cast<std::size_t>(c.id)];
        if (cs.violated == 0) continue;
        lines += fmt::format("  {:<16} on {} models, first --seed {} --replay {}\n", c.name, cs.violated, seed,
                             cs.first_violation);
      }
      return fmt::format("VIOLATED on {} of {} models.{}\n{}", s.violations, s.trials, interrupted, lines);
    }
    case ExitCode::undetermined:
      if (s.some_claim_never_decided()) {
        return fmt::format(
            "UNDETERMINED: no violation in {} models, but a claim that was asked for was decided on none of them; see "
            "--max-iterations, --max-positions.{}\n",
            s.trials, interrupted);
      }
      if (s.trials > 0 && s.vacuous()) {
        return fmt::format(
            "UNDETERMINED: every bound was vacuous on every model (at or above gamma span(R)/(1-gamma)), so this "
            "campaign verifies nothing. Ask for smaller eps, gamma or l_p, or --family informative.{}\n",
            interrupted);
      }
      return fmt::format("UNDETERMINED: {} models and no violation.{}\n", s.trials, interrupted);
    case ExitCode::assumption_fails:
      return fmt::format("ASSUMPTION FAILS on {} of {} models; no violation on the others.\n", s.assumption_failures,
                         s.trials);
    default:
      return fmt::format(
          "HOLDS: no violation in {} models. At most {:.3f} percent of such models violate a claim (95 percent upper "
          "limit).\n{}Seen in floating point, with certified numerical error; not a proof.\n",
          s.trials, 100 * s.violation_upper_limit(),
          s.undetermined == 0
              ? ""
              : fmt::format("Some claim is undetermined on {} of them: a budget ran out.\n", s.undetermined));
  }
}

std::string witness(const char* name, const LipschitzConstant<double>& c) {
  if (c.infinite) return fmt::format("  {:<14} infinite: states {} and {} at distance 0 differ\n", name, c.s1, c.s2);
  if (c.s1 == c.s2) return fmt::format("  {:<14} {:.6g}\n", name, c.value);
  const std::string target = c.target < 0 ? "" : fmt::format(", successor {}", c.target);
  return fmt::format("  {:<14} {:.6g}   attained by states {} and {}, action {}{}\n", name, c.value, c.s1, c.s2,
                     c.action, target);
}

std::string fate_text(const Examination& e) {
  if (e.fate == Fate::settled)
    return fmt::format("the policy pair settles at n = {}, seen at n = {}", e.periodic_from, e.iterations);
  if (e.fate == Fate::cycles) {
    return fmt::format("the policy pairs cycle with period {} from n = {}, seen at n = {}", e.period, e.periodic_from,
                       e.iterations);
  }
  return fmt::format("neither settled nor cycled in {} rounds", e.iterations);
}

std::string check_row(const Claim& claim, const Check& check, bool informative) {
  if (check.verdict == Verdict::not_asked) return "";
  if (check.verdict == Verdict::undetermined || check.verdict == Verdict::assumption_fails) {
    return fmt::format("  {:<16} {:<32} {}\n", claim.name, claim.title, to_string(check.verdict));
  }
  const std::string round = check.n < 0 ? "" : fmt::format("at n = {}", check.n);
  const char* worth = !claim.is_bound ? "" : informative ? "informative" : "vacuous";
  return fmt::format("  {:<16} {:<32} {:<9} {:>13.6g} <= {:<13.6g} {:>8} {:<12} {}\n", claim.name, claim.title,
                     to_string(check.verdict), check.left, check.right, ratio(check.tightness()), worth, round);
}

}  // namespace

ExitCode exit_code(const CampaignSummary& s, bool complete) {
  if (s.violations > 0) return ExitCode::violated;
  if (!complete || s.vacuous() || s.some_claim_never_decided()) return ExitCode::undetermined;
  return s.assumption_failures > 0 ? ExitCode::assumption_fails : ExitCode::holds;
}

ExitCode exit_code(const Examination& e) {
  if (e.any(Verdict::violated)) return ExitCode::violated;
  if (e.any(Verdict::assumption_fails)) return ExitCode::assumption_fails;
  return e.any(Verdict::undetermined) ? ExitCode::undetermined : ExitCode::holds;
}

std::string verdict_text(const CampaignSummary& s, Reading reading, std::uint64_t seed, bool complete) {
  std::string text = fmt::format("{} models, seed {}, reading {}\n\n", s.trials, seed, reading_text(reading));
  text += fmt::format("  {:<16} {:<32} {:>7} {:>8} {:>8} {:>11}  {:>8} {:>8} {:>8} {:>8}\n", "claim", "", "checked",
                      "violated", "undeter.", "informative", "median", "p99", "max", "at trial");
  for (const Claim& c : claims()) {
    const ClaimSummary& cs = s.claims[static_cast<std::size_t>(c.id)];
    if (cs.checked() + cs.undetermined + cs.assumption_fails > 0) text += claim_row(c, cs);
  }
  text +=
      "\n  informative: the bound is below gamma span(R)/(1-gamma); median, p99 and max are of (left - slack) / "
      "right\n\n";
  text += fmt::format("Q_n settled on {}, cycled on {}{}, neither on {}\n", s.settled, s.cycles, periods(s),
                      s.fate_undetermined);
  text += fmt::format(
      "Covered: a ball of several states on {}, the attack changes the action on {}, pessimism does on {}\n",
      s.balls_of_several, s.attack_changes_action, s.pessimism_changes_action);
  text += fmt::format("At least one bound informative on {} ({})\n\n", s.any_informative,
                      percent(s.any_informative, s.trials));
  return text + conclusion(s, seed, complete);
}

std::string verdict_text(const TrialRecord& record, Reading reading) {
  const Examination& e = record.found;
  std::string text =
      fmt::format("{}: {} states, {} actions, gamma {:g}, eps {:g}, largest ball {} states\nreading {}\n\n",
                  record.family, e.states, e.actions, e.discount, e.eps, e.largest_ball, reading_text(reading));
  text += witness("l_r", e.constants.l_r) + witness("l_p", e.constants.l_p) + witness("K", e.constants.k_tv);
  text += fmt::format("  {:<14} {:.6g}\n  {:<14} {:.6g}   (R from {:.6g} to {:.6g})\n", "L*", e.lipschitz_of_q_star,
                      "span(R)", e.constants.span, e.constants.r_min, e.constants.r_max_signed);
  text += fmt::format("  {:<14} {:.6g}   gamma span(R)/(1-gamma): a bound at or above it is vacuous\n\n", "trivial",
                      e.trivial);
  if (!e.failed_assumption.empty()) return text + "ASSUMPTION FAILS: " + e.failed_assumption + "\n";
  text += fmt::format("Q_n: {}; {} different pairs; limsup gap {}\n\n", fate_text(e), e.pairs,
                      e.fate == Fate::undetermined ? "unknown" : fmt::format("{:.6g}", e.gap));
  long vacuous = 0, bounds_checked = 0;
  for (const Claim& c : claims()) {
    const Check& check = e.check(c.id);
    text += check_row(c, check, e.informative(c.id));
    const bool checked = check.verdict == Verdict::holds || check.verdict == Verdict::violated;
    bounds_checked += c.is_bound && checked;
    vacuous += c.is_bound && checked && !e.informative(c.id);
  }
  switch (exit_code(e)) {
    case ExitCode::violated:
      return text + "\nVIOLATED: a claim above fails on this model.\n";
    case ExitCode::undetermined:
      return text +
             "\nUNDETERMINED: a budget ran out before every claim was decided; see --max-iterations, "
             "--max-positions.\n";
    default:
      return text + fmt::format("\nHOLDS on this model, in floating point with certified error{}\n",
                                vacuous == bounds_checked ? "; but every bound is vacuous here." : ".");
  }
}

}  // namespace maximin
