#include <maximin/proofs_check/falsify/goal.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/belief_positions.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

constexpr double none = -std::numeric_limits<double>::infinity();

constexpr const char* settling = "settling";
constexpr const char* sharper_belief = "sharper-belief";

double tightness_of(ClaimId id, const Model<double>& model, ExaminationOptions options) {
  options.only = {id};
  const Check check = examine(model.mdp, make_perturbation(model), options).check(id);
  const bool decided = check.verdict == Verdict::holds || check.verdict == Verdict::violated;
  return decided ? check.tightness() : none;
}

/// States that no observation can tell apart although they differ are no finding.
bool has_constants(const Model<double>& model, const Perturbation<double>& balls) {
  return model_constants(model.mdp, balls.metric()).finite();
}

double period_of(const Model<double>& model, const ExaminationOptions& options) {
  const auto balls = make_perturbation(model);
  if (!has_constants(model, balls)) return none;
  PessimisticQIterationOptions<double> iteration;
  iteration.max_iterations = options.max_iterations;
  iteration.max_period = options.max_period;
  iteration.tie = options.tie;
  const auto run = pessimistic_q_iteration(model.mdp, balls, iteration);
  // Among models that settle, those that take many pairs to do so are nearer to a cycle.
  if (run.fate == Fate::undetermined) return none;
  return run.period > 1 ? static_cast<double>(run.period) : 1 - 1.0 / static_cast<double>(1 + run.pairs.size());
}

double loss_of_the_sharper_belief(const Model<double>& model, const ExaminationOptions& options) {
  const auto balls = make_perturbation(model);
  const auto optimal = policy_iteration(model.mdp);
  const double span = model.mdp.rewards().maxCoeff() - model.mdp.rewards().minCoeff();
  if (!(span > 0) || !has_constants(model, balls)) return none;
  Policy policy;
  std::vector<double> scratch;
  maximin_policy(optimal.q, balls, policy, scratch, MinAggregator{}, options.tie);
  const auto on_ball = evaluate_against_optimal_attack(model.mdp, balls, policy);
  BeliefGameOptions game;
  game.max_positions = options.max_belief_positions;
  const auto on_belief = solve_belief_game(model.mdp, balls, maximin_belief_policy(optimal.q, options.tie), game);
  const double errors = 2 * (on_ball.error + on_belief.error);
  // The robust values of a policy are by the true state before it is shown, as those of the game are.
  return ((on_ball.v - on_belief.v).maxCoeff() - errors) * (1 - model.mdp.discount()) / span;
}

Verdict verdict_on_settling(const Examination& found) {
  if (found.fate == Fate::undetermined) return Verdict::undetermined;
  return found.fate == Fate::cycles ? Verdict::violated : Verdict::holds;
}

/// Whether the maximin policy of Q* is worth more on the ball than on the belief somewhere. Values on the belief that
/// are only bounded from below decide nothing.
Verdict verdict_on_the_sharper_belief(const Certificate& c) {
  if (!c.belief_game || !c.belief_game->exact) return Verdict::undetermined;
  const Values<Rational> on_belief = start_values(*c.belief_game, ExactGeometry(c.model).balls());
  for (State s = 0; s < on_belief.size(); ++s) {
    if (c.test_time_robust[s] > on_belief[s]) return Verdict::violated;
  }
  return Verdict::holds;
}

Verdict sharper_belief_proved(const Model<Rational>& model, ExaminationOptions options) {
  options.only = std::set{ClaimId::f_belief};
  try {
    return verdict_on_the_sharper_belief(certify(model, {}, certify_options(options)));
  } catch (const AssumptionFails&) {
    return Verdict::assumption_fails;
  } catch (const BudgetExhausted&) {
    return Verdict::undetermined;
  }
}

}  // namespace

const std::vector<Goal>& goals() {
  static const std::vector<Goal> all = [] {
    std::vector<Goal> list;
    for (const Claim& c : claims()) list.push_back({std::string(c.name), std::string(c.title), c.id, 1});
    list.push_back({settling, "pessimistic Q-iteration settles", std::nullopt, 1});
    list.push_back({sharper_belief, "a sharper belief never hurts", std::nullopt, 0});
    return list;
  }();
  return all;
}

const Goal* find_goal(std::string_view name) {
  const auto& all = goals();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Goal& g) { return g.name == name; });
  return found == all.end() ? nullptr : &*found;
}

double score(const Goal& goal, const Model<double>& model, const ExaminationOptions& options) {
  try {
    if (goal.claim) return tightness_of(*goal.claim, model, options);
    return goal.name == settling ? period_of(model, options) : loss_of_the_sharper_belief(model, options);
  } catch (const std::runtime_error&) {
    return none;  // no valid model, or one too hard to decide
  }
}

Verdict proved(const Goal& goal, const Model<double>& model, const ExaminationOptions& options) {
  ExaminationOptions exact = options;
  exact.only.emplace();
  if (goal.claim) exact.only->insert(*goal.claim);
  if (goal.name == sharper_belief) return sharper_belief_proved(rationalise(model), exact);
  const Examination found = examine_exactly(rationalise(model), {}, exact);
  return goal.claim ? found.check(*goal.claim).verdict : verdict_on_settling(found);
}

}  // namespace maximin
