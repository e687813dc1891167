#include <maximin/tabular/pessimistic_q_learning.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {
namespace {

std::size_t index(State s) {
  return static_cast<std::size_t>(s);
}

void check_chance(double chance) {
  if (chance >= 0 && chance <= 1) return;
  throw InputError(fmt::format("exploration: chance {}, expected a number from 0 to 1", chance));
}

/// What the attacker shows in a state and what the learner does then.
struct Response {
  State shown = 0;
  Action action = 0;
};

/// The t in B(s) with the least q(s, pi(t)), given pi on B(s), in the order of the ball.
template <class Scalar, class PolicyOf>
Response worst_response(const QTable<Scalar>& q, State s, std::span<const State> ball, PolicyOf policy, TieBreak tie) {
  const auto i = internal::arg_best<std::size_t>(
      ball.size(), [&](std::size_t k) { return q(s, policy(k)); }, [](auto& x, auto& y) { return x < y; }, tie);
  return {ball[i], policy(i)};
}

/// pi and omega_pi of a Q that changes one entry at a time, the learner holding possible every state of the ball.
template <class Scalar>
class BallLearner {
 public:
  BallLearner(const QTable<Scalar>& q, const Perturbation<Scalar>& perturbation, TieBreak tie)
      : q_(q), perturbation_(perturbation), tie_(tie) {
    least_.resize(q.rows(), q.cols());
    policy_.resize(static_cast<std::size_t>(q.rows()));
    for (State t = 0; t < q.rows(); ++t) {
      for (Action a = 0; a < q.cols(); ++a) refresh_least(t, a);
      refresh_policy(t);
    }
  }

  void begin() {}
  void advance(const Response&, Action) {}

  Response respond(State s) const {
    const auto ball = perturbation_.ball(s);
    return worst_response(
        q_, s, ball, [&](std::size_t k) { return policy_[index(ball[k])]; }, tie_);
  }

  /// To be told after q(s,a) has changed from `before`. Balls are symmetric: the t whose ball holds s are those of
  /// B(s).
  void entry_changed(State s, Action a, const Scalar& before) {
    const Scalar& now = q_(s, a);
    for (const State t : perturbation_.ball(s)) {
      if (now <= least_(t, a)) {
        least_(t, a) = now;
      } else if (before <= least_(t, a)) {
        refresh_least(t, a);
      }
      refresh_policy(t);
    }
  }

 private:
  void refresh_least(State t, Action a) {
    const auto ball = perturbation_.ball(t);
    Scalar least = q_(ball.front(), a);
    for (const State m : ball.subspan(1)) least = std::min(least, q_(m, a));
    least_(t, a) = least;
  }

  void refresh_policy(State t) {
    policy_[index(t)] = internal::arg_best<Action>(
        static_cast<Action>(q_.cols()), [&](Action a) { return least_(t, a); }, [](auto& x, auto& y) { return x > y; },
        tie_);
  }

  const QTable<Scalar>& q_;
  const Perturbation<Scalar>& perturbation_;
  TieBreak tie_;
  QTable<Scalar> least_;  // min_{m in B(t)} q(m,a)
  Policy policy_;
};

/// The same with the belief in the place of the ball. Nothing is kept of pi: it depends on the history.
template <class Scalar>
class BeliefLearner {
 public:
  BeliefLearner(const QTable<Scalar>& q, const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                TieBreak tie)
      : q_(q), mdp_(mdp), perturbation_(perturbation), tie_(tie) {}

  void begin() { started_ = false; }

  /// The learner was shown response.shown and did `action`.
  void advance(const Response& response, Action action) {
    uncertain(response.shown);
    belief_successors(mdp_, std::span<const State>(belief_), action, predicted_);
    started_ = true;
  }

  Response respond(State s) {
    const auto ball = perturbation_.ball(s);
    actions_.clear();
    for (const State t : ball) {
      uncertain(t);
      actions_.push_back(belief_action(q_, std::span<const State>(belief_), scratch_, MinAggregator{}, tie_));
    }
    return worst_response(
        q_, s, ball, [&](std::size_t k) { return actions_[k]; }, tie_);
  }

  void entry_changed(State, Action, const Scalar&) {}

 private:
  /// belief_ = M(t). The two always meet, since the truth is in both.
  void uncertain(State t) {
    const auto ball = perturbation_.ball(t);
    if (started_) {
      meet_observation(perturbation_, std::span<const State>(predicted_), t, belief_);
    } else {
      belief_.assign(ball.begin(), ball.end());
    }
  }

  const QTable<Scalar>& q_;
  const FiniteMdp<Scalar>& mdp_;
  const Perturbation<Scalar>& perturbation_;
  TieBreak tie_;
  bool started_ = false;
  Belief predicted_, belief_;
  std::vector<Action> actions_;
  std::vector<Scalar> scratch_;
};

template <class Scalar, class Learner>
class Training {
 public:
  Training(const TabularEnvironment<Scalar>& env, const PessimisticQLearningOptions& options,
           PessimisticQLearning<Scalar>& result, Learner learner)
      : env_(env), options_(options), result_(result), learner_(std::move(learner)) {
    state_visits_.resize(index(env.mdp().states()));
  }

  /// Plays one episode. Returns its discounted return and the largest update.
  std::pair<double, double> play(Stream& rng) {
    double discounted = 0, weight = 1, largest = 0;
    State s = env_.reset(rng);
    learner_.begin();
    Response response = learner_.respond(s);
    for (long t = 0; t < options_.horizon; ++t) {
      const Action a = behave(s, response, rng);
      const Outcome<State> outcome = env_.step(s, a, rng);
      learner_.advance(response, a);
      const State next = outcome.next;
      const Scalar bootstrap = outcome.terminal ? Scalar(0) : result_.q(next, learner_.respond(next).action);
      largest = std::max(largest, update(s, a, bootstrap));
      discounted += weight * outcome.reward;
      weight *= static_cast<double>(env_.mdp().discount());
      ++result_.steps;
      if (outcome.terminal) break;
      s = next;
      response = learner_.respond(s);
    }
    return {discounted, largest};
  }

 private:
  Action behave(State s, const Response& response, Stream& rng) {
    const double chance = options_.exploration(result_.steps, state_visits_[index(s)]++);
    return rng.chance(chance) ? static_cast<Action>(rng.below(env_.mdp().actions())) : response.action;
  }

  /// Line 11. Returns how far the entry moved.
  double update(State s, Action a, const Scalar& bootstrap) {
    Scalar& entry = result_.q(s, a);
    const Scalar before = entry;
    const auto alpha = static_cast<Scalar>(options_.step_size(result_.visits(s, a)++));
    entry += alpha * (env_.mdp().reward(s, a) + env_.mdp().discount() * bootstrap - entry);
    learner_.entry_changed(s, a, before);
    return static_cast<double>(std::abs(entry - before));
  }

  const TabularEnvironment<Scalar>& env_;
  const PessimisticQLearningOptions& options_;
  PessimisticQLearning<Scalar>& result_;
  Learner learner_;
  std::vector<long> state_visits_;
};

template <class Scalar, class Learner>
void train(const TabularEnvironment<Scalar>& env, const PessimisticQLearningOptions& options,
           const LearningObserver<Scalar>& observe, PessimisticQLearning<Scalar>& result, Learner learner) {
  Training<Scalar, Learner> training(env, options, result, std::move(learner));
  while (result.episodes < options.episodes) {
    Stream rng(options.seed, static_cast<std::uint64_t>(result.episodes));
    const auto [discounted, largest] = training.play(rng);
    const long episode = result.episodes++;
    if (observe && !observe({episode, result.steps, discounted, largest, result.q})) break;
  }
}

}  // namespace

ExplorationSchedule ExplorationSchedule::constant(double chance) {
  check_chance(chance);
  return {Kind::linear, chance, chance, 1};
}

ExplorationSchedule ExplorationSchedule::linear(double first, double last, long steps) {
  check_chance(first);
  check_chance(last);
  if (steps < 1) throw InputError(fmt::format("exploration: {} steps, expected at least 1", steps));
  return {Kind::linear, first, last, static_cast<double>(steps)};
}

ExplorationSchedule ExplorationSchedule::by_visits(double scale) {
  if (!(scale > 0)) throw InputError(fmt::format("exploration: scale {}, expected a positive number", scale));
  return {Kind::by_visits, 1, 0, scale};
}

double ExplorationSchedule::operator()(long step, long visits) const {
  if (kind_ == Kind::by_visits) return scale_ / (scale_ + static_cast<double>(visits));
  const double done = std::min(1.0, static_cast<double>(step) / scale_);
  return first_ + (last_ - first_) * done;
}

StepSizeSchedule StepSizeSchedule::constant(double alpha) {
  if (!(alpha > 0 && alpha <= 1)) {
    throw InputError(fmt::format("step size: {}, expected a number above 0 and at most 1", alpha));
  }
  return {Kind::constant, alpha};
}

StepSizeSchedule StepSizeSchedule::polynomial(double exponent) {
  if (!(exponent > 0 && exponent <= 1)) {
    throw InputError(fmt::format("step size: exponent {}, expected a number above 0 and at most 1", exponent));
  }
  return {Kind::polynomial, exponent};
}

double StepSizeSchedule::operator()(long visits) const {
  return kind_ == Kind::constant ? value_ : std::pow(1 + static_cast<double>(visits), -value_);
}

template <class Scalar>
PessimisticQLearning<Scalar> pessimistic_q_learning(const TabularEnvironment<Scalar>& env,
                                                    const Perturbation<Scalar>& perturbation,
                                                    const PessimisticQLearningOptions& options,
                                                    const LearningObserver<Scalar>& observe) {
  const FiniteMdp<Scalar>& mdp = env.mdp();
  if (perturbation.states() != mdp.states()) {
    throw InputError(fmt::format("balls: {} states, expected {} like the model", perturbation.states(), mdp.states()));
  }
  if (options.episodes < 1) throw InputError(fmt::format("episodes: {}, expected at least 1", options.episodes));
  if (options.horizon < 1) throw InputError(fmt::format("horizon: {}, expected at least 1", options.horizon));
  PessimisticQLearning<Scalar> result;
  result.q = QTable<Scalar>::Zero(mdp.states(), mdp.actions());
  result.visits = QTable<long>::Zero(mdp.states(), mdp.actions());
  if (options.uncertainty == Uncertainty::ball) {
    train(env, options, observe, result, BallLearner<Scalar>(result.q, perturbation, options.tie));
  } else {
    train(env, options, observe, result, BeliefLearner<Scalar>(result.q, mdp, perturbation, options.tie));
  }
  std::vector<Scalar> scratch;
  maximin_policy(result.q, perturbation, result.policy, scratch, MinAggregator{}, options.tie);
  best_response_attack(result.q, result.policy, perturbation, result.attack, options.tie);
  return result;
}

template PessimisticQLearning<double> pessimistic_q_learning(const TabularEnvironment<double>&,
                                                             const Perturbation<double>&,
                                                             const PessimisticQLearningOptions&,
                                                             const LearningObserver<double>&);

}  // namespace maximin
