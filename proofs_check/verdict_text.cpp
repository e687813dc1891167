#include <maximin/proofs_check/verdict_text.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

#include <maximin/theory/rational.hpp>

namespace maximin {
namespace {

constexpr const char* only_within_rounding =
    "held within rounding, not certified (--pedantic); --exact proves what holds.";

std::string percent(long part, long whole) {
  if (whole == 0) return "-";
  return fmt::format("{:.1f}%", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// "1 model", "2 models".
std::string counted(long n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string ratio(double x) {
  return std::isfinite(x) ? fmt::format("{:.4f}", x) : "-";
}

std::string reading_text(const ExaminationOptions& options) {
  return options.reading == Reading::paper ? "as the paper prints it: R_max = max(0, max R)"
                                           : "corrected: R_max = max |R|";
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

std::string conclusion(const CampaignSummary& s, std::string_view draw, bool complete,
                       const ExaminationOptions& options) {
  const char* interrupted = complete ? "" : " The run was interrupted; --resume completes it.";
  switch (outcome(s, complete, options)) {
    case Outcome::violated: {
      std::string lines;
      for (const Claim& c : claims()) {
        const ClaimSummary& cs = s.claims[static_cast<std::size_t>(c.id)];
        if (cs.violated == 0) continue;
        lines += fmt::format("  {:<16} on {}, the first: verify_bound {} --replay {}\n", c.name,
                             counted(cs.violated, "model"), draw, cs.first_violation);
      }
      return fmt::format("VIOLATED on {} of {}.{}\n{}", s.violations, counted(s.trials, "model"), interrupted, lines);
    }
    case Outcome::undetermined:
      if (s.some_claim_never_decided()) {
        return fmt::format(
            "UNDETERMINED: no violation in {}, but a claim that was asked for was decided on none of them; see "
            "--max-iterations, --max-period, --max-positions.{}\n",
            counted(s.trials, "model"), interrupted);
      }
      if (s.trials > 0 && s.vacuous()) {
        return fmt::format(
            "UNDETERMINED: every bound was vacuous on every model (at or above gamma span(R)/(1-gamma)), so this "
            "campaign verifies nothing. Ask for smaller eps, gamma or l_p, or --family informative.{}\n",
            interrupted);
      }
      if (complete && outcome(s, complete) == Outcome::holds) {
        return fmt::format("UNDETERMINED: no violation in {}, but what held there {}\n", counted(s.trials, "model"),
                           only_within_rounding);
      }
      return fmt::format("UNDETERMINED: {} and no violation.{}\n", counted(s.trials, "model"), interrupted);
    case Outcome::assumption_fails:
      return fmt::format("ASSUMPTION FAILS on {} of {}; no violation on the others.\n", s.assumption_failures,
                         counted(s.trials, "model"));
    default:
      return fmt::format(
          "HOLDS: no violation in {}. At most {:.3f} percent of such models violate a claim (95 percent upper "
          "limit).\n{}{}\n",
          counted(s.trials, "model"), 100 * s.violation_upper_limit(),
          s.undetermined == 0
              ? ""
              : fmt::format("Some claim is undetermined on {} of them: {}.\n", s.undetermined,
                            options.by_bounds ? "bounds do not show what holds with next to nothing to spare"
                                              : "a budget ran out"),
          options.exact ? "What holds is proved in exact arithmetic, for each model; of other models nothing is proved."
                        : "Seen in floating point, with certified numerical error; not a proof.");
  }
}

template <class Scalar>
std::string witness(const char* name, const LipschitzConstant<double>& c, const Model<Scalar>& model) {
  const std::string pair = fmt::format("states {} and {}", model.state_name(c.s1), model.state_name(c.s2));
  if (c.infinite) return fmt::format("  {:<14} infinite: {} at distance 0 differ\n", name, pair);
  if (c.s1 == c.s2) return fmt::format("  {:<14} {:.6g}\n", name, c.value);
  const std::string target = c.target < 0 ? "" : ", successor " + model.state_name(c.target);
  return fmt::format("  {:<14} {:.6g}   attained by {}, action {}{}\n", name, c.value, pair,
                     model.action_name(c.action), target);
}

std::string fate_text(const Examination& e, bool exact) {
  if (exact && e.fate == Fate::settled)
    return fmt::format("the policy pair settles, proved from n = {} on", e.iterations);
  if (exact && e.fate == Fate::cycles) {
    return fmt::format("the policy pairs cycle with period {}, proved from n = {} on", e.period, e.iterations);
  }
  if (e.fate == Fate::settled)
    return fmt::format("the policy pair settles at n = {}, seen at n = {}", e.periodic_from, e.iterations);
  if (e.fate == Fate::cycles) {
    return fmt::format("the policy pairs cycle with period {} from n = {}, seen at n = {}", e.period, e.periodic_from,
                       e.iterations);
  }
  if (e.enclosed_from >= 0) return fmt::format("enclosed from n = {} on, for ever, by bounds", e.enclosed_from);
  return fmt::format("neither settled nor cycled in {} rounds (--max-iterations, --max-period)", e.iterations);
}

/// "at n = 4, states 1 and 2, action 0": where the tightest instance of a claim stands.
template <class Scalar>
std::string place_text(const Check& check, const Model<Scalar>& model) {
  std::vector<std::string> parts;
  const Place& at = check.place;
  if (check.n >= 0) parts.push_back(fmt::format("n = {}", check.n));
  if (at.other >= 0) {
    parts.push_back(fmt::format("states {} and {}", model.state_name(at.state), model.state_name(at.other)));
  } else if (at.state >= 0) {
    parts.push_back("state " + model.state_name(at.state));
  }
  if (at.action >= 0) parts.push_back("action " + model.action_name(at.action));
  return parts.empty() ? "" : fmt::format("at {}", fmt::join(parts, ", "));
}

template <class Scalar>
std::string check_row(const Claim& claim, const Check& check, bool informative, const Model<Scalar>& model,
                      const ExaminationOptions& options, bool beyond_doubles) {
  if (check.verdict == Verdict::not_asked) return "";
  if (check.verdict == Verdict::undetermined || check.verdict == Verdict::assumption_fails) {
    return fmt::format("  {:<16} {:<32} {}\n", claim.name, claim.title, to_string(check.verdict));
  }
  const bool doubted = check.verdict == Verdict::holds && options.doubts_what_holds();
  const std::string_view verdict = doubted ? "held" : to_string(check.verdict);
  const char* worth = !claim.is_bound || beyond_doubles ? "" : informative ? "informative" : "vacuous";
  return fmt::format("  {:<16} {:<32} {:<9} {:>13.6g} <= {:<13.6g} {:>8} {:<12} {}\n", claim.name, claim.title, verdict,
                     check.left, check.right, ratio(check.tightness()), worth, place_text(check, model));
}

/// What the table of claims shows of an exact run, which is not what one in floating point shows.
std::string sides_legend(const Examination& e, const ExaminationOptions& options) {
  if (!options.exact) return "";
  std::string text =
      "\n  left <= right and left/right are of the instance with the least right - left, not with the largest "
      "left/right\n";
  bool enclosed = false, huge = false;
  if (options.by_bounds) text += "  left is never too small, right never too large: what holds is proved\n";
  for (const ClaimId id : {ClaimId::lemma_1_iterates, ClaimId::lemma_2}) {
    enclosed =
        enclosed || (!options.by_bounds && e.check(id).verdict == Verdict::holds && e.check(id).n >= e.iterations);
  }
  for (const Check& check : e.checks) huge = huge || !std::isfinite(check.left) || !std::isfinite(check.right);
  if (enclosed) {
    text += fmt::format(
        "  lemma-1-iterates and lemma-2 from n = {} on: left is an upper bound for all rounds of one phase\n",
        e.iterations);
  }
  if (huge) text += "  inf: beyond floating point; verify_bound certify writes the exact numbers\n";
  return text;
}

}  // namespace

Outcome outcome(const CampaignSummary& s, bool complete, const ExaminationOptions& options) {
  if (s.violations > 0) return Outcome::violated;
  if (!complete || s.vacuous() || s.some_claim_never_decided()) return Outcome::undetermined;
  if (s.assumption_failures > 0) return Outcome::assumption_fails;
  return options.doubts_what_holds() ? Outcome::undetermined : Outcome::holds;
}

Outcome outcome(const Examination& e, const ExaminationOptions& options) {
  if (e.any(Verdict::violated)) return Outcome::violated;
  if (e.any(Verdict::assumption_fails)) return Outcome::assumption_fails;
  const bool doubted = options.doubts_what_holds() && e.any(Verdict::holds);
  return doubted || e.any(Verdict::undetermined) ? Outcome::undetermined : Outcome::holds;
}

std::string verdict_text(const CampaignSummary& s, const ExaminationOptions& options, std::string_view draw,
                         bool complete) {
  std::string text = fmt::format("{} ({}), reading {}\n\n", counted(s.trials, "model"), draw, reading_text(options));
  text += fmt::format("  {:<16} {:<32} {:>7} {:>8} {:>8} {:>11}  {:>8} {:>8} {:>8} {:>8}\n", "claim", "", "checked",
                      "violated", "undeter.", "informative", "median", "p99", "max", "at trial");
  for (const Claim& c : claims()) {
    const ClaimSummary& cs = s.claims[static_cast<std::size_t>(c.id)];
    if (cs.checked() + cs.undetermined + cs.assumption_fails > 0) text += claim_row(c, cs);
  }
  text += fmt::format(
      "\n  informative: the bound is below gamma span(R)/(1-gamma); median, p99 and max are of {}\n  What each claim "
      "states: verify_bound --explain\n\n",
      options.exact ? "left / right where right - left\n  is least on a model, not of the largest left / right"
                    : "(left - slack) / right");
  text += options.by_bounds ? "Q_n: enclosed, not followed\n"
                            : fmt::format("Q_n settled on {}, cycled on {}{}, neither on {}\n", s.settled, s.cycles,
                                          periods(s), s.fate_undetermined);
  text += fmt::format(
      "Covered: a ball of several states on {}, the attack changes the action on {}, pessimism does on {}\n",
      s.balls_of_several, s.attack_changes_action, s.pessimism_changes_action);
  text += fmt::format("At least one bound informative on {} ({})\n\n", s.any_informative,
                      percent(s.any_informative, s.trials));
  return text + conclusion(s, draw, complete, options);
}

template <class Scalar>
std::string verdict_text(std::string_view title, const Model<Scalar>& model, const Examination& e,
                         const ExaminationOptions& options) {
  std::string text = fmt::format("{}: {}, {}, gamma {:g}, eps {:g}, largest ball {}\nreading {}\n\n", title,
                                 counted(e.states, "state"), counted(e.actions, "action"), e.discount, e.eps,
                                 counted(e.largest_ball, "state"), reading_text(options));
  const auto& constants = e.constants;
  text += witness("l_r", constants.l_r, model) + witness("l_p", constants.l_p, model);
  text += witness("K", constants.k_tv, model);
  text += fmt::format("  {:<14} {:.6g}\n  {:<14} {:.6g}   (R from {:.6g} to {:.6g})\n", "L*", e.lipschitz_of_q_star,
                      "span(R)", e.constants.span, e.constants.r_min, e.constants.r_max_signed);
  text += fmt::format("  {:<14} {:.6g}   gamma span(R)/(1-gamma): a bound at or above it is vacuous\n\n", "trivial",
                      e.trivial);
  if (!e.failed_assumption.empty()) return text + "ASSUMPTION FAILS: " + e.failed_assumption + "\n";
  text +=
      fmt::format("Q_n: {}; {} met; limsup gap {}\n\n", fate_text(e, options.exact), counted(e.pairs, "policy pair"),
                  e.fate == Fate::undetermined ? "unknown" : fmt::format("{:.6g}", e.gap));
  long vacuous = 0, bounds_checked = 0;
  for (const Claim& c : claims()) {
    const Check& check = e.check(c.id);
    text += check_row(c, check, e.informative(c.id), model, options, !std::isfinite(e.trivial));
    const bool checked = check.verdict == Verdict::holds || check.verdict == Verdict::violated;
    bounds_checked += c.is_bound && checked;
    vacuous += c.is_bound && checked && std::isfinite(e.trivial) && !e.informative(c.id);
  }
  text += sides_legend(e, options);
  switch (outcome(e, options)) {
    case Outcome::violated:
      return text + "\nVIOLATED: a claim above fails on this model.\n";
    case Outcome::undetermined:
      if (!e.any(Verdict::undetermined)) {
        return text + fmt::format("\nUNDETERMINED: what held above {}\n", only_within_rounding);
      }
      return text +
             (options.exact
                  ? "\nUNDETERMINED: what holds above is proved, a claim is open; verify_bound certify says more.\n"
                  : "\nUNDETERMINED: a budget ran out before every claim was decided; see --max-iterations, "
                    "--max-period, --max-positions.\n");
    default:
      return text + fmt::format("\nHOLDS on this model, {}{}\n",
                                options.exact ? "proved in exact arithmetic" : "in floating point with certified error",
                                vacuous == bounds_checked ? "; but every bound is vacuous here." : ".");
  }
}

template std::string verdict_text(std::string_view, const Model<double>&, const Examination&,
                                  const ExaminationOptions&);
template std::string verdict_text(std::string_view, const Model<Rational>&, const Examination&,
                                  const ExaminationOptions&);

std::string claims_text() {
  std::string text;
  for (const Claim& c : claims()) {
    text += fmt::format("{}: {} ({})\n    {}\n", c.name, c.title, c.reference, c.statement);
  }
  return text + R"(
s, t, a    states and an action; |x_s-x_t| is their distance, and |Q| of a table is its largest absolute entry
g          gamma, the discount;  |S| the number of states
eps        radius of the balls: the attacker shows any state within eps of the true one
l_r, l_p   Lipschitz constants of the rewards and of the transition probabilities P(s'|.,a), the largest over s'
K          the same of P(.|s,a) in total variation: at most |S| l_p / 2
R_max      max |R| (--reading corrected) or max(0, max R) (--reading paper, Assumption 2 as printed)
span(R)    max R - min R
T*, Q*     the Bellman operator without an attacker, and its fixed point;  V* = max_a Q*;  L* its Lipschitz constant
Q_n        round n of pessimistic Q-iteration, with pi_n its maximin policy and omega_n the best response to it
Q^{pi_n o omega_n}        the value of pi_n when omega_n attacks
Q^{pi_n, best attack}     the value of pi_n against its optimal attacker, the most that an attack can cost
d_0, u_0   how far the iteration starts off: d_0 = max(0, max Q*), u_0 = max(0, -min Q*), for Q_0 = 0
rho        the largest distance from a true state to a member of the belief held in it, at most 2 eps
limsup     over the rounds of the cycle that the policy pairs (pi_n, omega_n) enter; of period 1 when they settle
)";
}

}  // namespace maximin
