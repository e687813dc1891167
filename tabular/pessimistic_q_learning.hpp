#pragma once

#include <cstdint>
#include <functional>

#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// epsilon', the chance that the learner does a random action instead of its own (paper, Algorithm 1 line 9). The
/// random action is any of the actions, all equally likely.
class ExplorationSchedule {
 public:
  /// Always `chance`. Throws InputError unless 0 <= chance <= 1.
  static ExplorationSchedule constant(double chance);
  /// From `first` at step 0 straight to `last` at step `steps`, and `last` from then on. Throws InputError unless both
  /// are in [0, 1] and steps >= 1.
  static ExplorationSchedule linear(double first, double last, long steps);
  /// scale / (scale + n), n the number of earlier visits of the state: 1 at first, never 0. Throws InputError unless
  /// scale > 0.
  static ExplorationSchedule by_visits(double scale);

  /// `step` counts all steps before this one, `visits` the earlier visits of the state.
  double operator()(long step, long visits) const;

 private:
  enum class Kind { linear, by_visits };
  ExplorationSchedule(Kind kind, double first, double last, double scale)
      : kind_(kind), first_(first), last_(last), scale_(scale) {}

  Kind kind_;
  double first_, last_;
  double scale_;  // steps, or visits
};

/// alpha, the weight of a new sample (paper, Algorithm 1 line 11).
class StepSizeSchedule {
 public:
  /// Always alpha. Throws InputError unless 0 < alpha <= 1.
  static StepSizeSchedule constant(double alpha);
  /// 1 / (1+n)^exponent, n the number of earlier updates of the (state, action). Averages the noise away when the
  /// exponent is above 1/2; 1 is the plain mean, which forgets its poor start slowly. Throws InputError unless 0 <
  /// exponent <= 1.
  static StepSizeSchedule polynomial(double exponent);

  double operator()(long visits) const;

 private:
  enum class Kind { constant, polynomial };
  StepSizeSchedule(Kind kind, double value) : kind_(kind), value_(value) {}

  Kind kind_;
  double value_;
};

/// What the learner takes the truth to be, given what it is shown.
enum class Uncertainty {
  ball,    ///< any state of B(t): Algorithm 1 as printed
  belief,  ///< any state of its belief M_t (paper, section 3.3)
};

struct PessimisticQLearningOptions {
  Uncertainty uncertainty = Uncertainty::ball;
  long episodes = 1000;
  long horizon = 1000;  ///< steps after which an episode is cut; the last step still bootstraps
  ExplorationSchedule exploration = ExplorationSchedule::constant(0.1);
  StepSizeSchedule step_size = StepSizeSchedule::polynomial(0.7);
  TieBreak tie = TieBreak::lowest_index;
  std::uint64_t seed = 1;  ///< episode k draws from Stream(seed, k)
};

/// After each episode: how it went, for a learning curve.
template <class Scalar>
struct LearningProgress {
  long episode = 0;              ///< from 0
  long steps = 0;                ///< of all episodes so far
  double discounted_return = 0;  ///< of the learner as it behaved: attacked, and exploring
  double largest_update = 0;     ///< of any entry of Q in this episode
  const QTable<Scalar>& q;
};

/// Called after each episode. Returning false ends the learning.
template <class Scalar>
using LearningObserver = std::function<bool(const LearningProgress<Scalar>&)>;

template <class Scalar>
struct PessimisticQLearning {
  QTable<Scalar> q;     ///< |S| x |A|, by true state
  Policy policy;        ///< argmax_a min_{m in B(t)} q(m,a), by observation
  AttackPolicy attack;  ///< the best response to it, by true state
  QTable<long> visits;  ///< updates of each (state, action)
  long episodes = 0;
  long steps = 0;
};

/// Pessimistic Q-learning (paper, Algorithm 1): from Q = 0, in each step the attacker shows omega_pi(s), the learner
/// does a = pi(omega_pi(s)) or explores, and
///
///     Q(s,a) <- Q(s,a) + alpha [ R(s,a) + gamma Q(s', pi(omega_pi(s'))) - Q(s,a) ],
///
/// with pi(t) = argmax_a min_{m in B(t)} Q(m,a) and omega_pi(s) = argmin_{t in B(s)} Q(s, pi(t)), both of the Q before
/// the update. The printed algorithm computes them anew for all states in every step; here only what the update touches
/// is computed, with the same result. The value of a terminal state is 0.
///
/// With Uncertainty::belief the learner holds M_t in the place of the ball. Shown t in state s after action a_{t-1},
/// its belief would be M(t) = M'_{t-1} met with B(t), M'_{t-1} = succ(M_{t-1}, a_{t-1}), or the ball B(t) alone at the
/// start of an episode; it would do pi(t) = argmax_a min_{m in M(t)} Q(m,a); and the attacker shows the t in B(s) that
/// minimises Q(s, pi(t)). The target bootstraps in the same way one step on: at s', from M'_t = succ(M_t, a_t) with the
/// action really taken, after the attacker's observation of s' by the Q before the update. (The paper's deep variant
/// bootstraps s' from M_t, a belief about s.) What is learned still depends on the true state alone: where one state is
/// met under several beliefs, Q(s,a) averages over them as often as they occur. The belief needs to know which
/// transitions are possible, so this variant is not free of the model.
///
/// The operator is not a contraction, and there is no guarantee of convergence. Where pessimistic Q-iteration settles,
/// learning usually approaches its fixed point, but it may find another fixed point, or rest at the border between two
/// policy pairs where the targets of the two, taken in turn, balance: there Q stands still and is not a fixed point.
///
/// Deterministic: the result is a function of the arguments. Throws InputError on options out of range or when sizes do
/// not match.
template <class Scalar>
PessimisticQLearning<Scalar> pessimistic_q_learning(const TabularEnvironment<Scalar>& env,
                                                    const Perturbation<Scalar>& perturbation,
                                                    const PessimisticQLearningOptions& options = {},
                                                    const LearningObserver<Scalar>& observe = {});

}  // namespace maximin
