#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include <maximin/tabular/tabular_agents.hpp>
#include <maximin/theory/concepts.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/types.hpp>

/// Attacks on tabular agents. What they take by reference must outlive them.
namespace maximin {

/// Shows the truth.
struct NoAttack {
  template <class AgentT>
  State perturb(State truth, const AgentT&, Stream&) const {
    return truth;
  }
};

/// Shows any state of B(s), all equally likely.
template <class Scalar>
class RandomAttack {
 public:
  explicit RandomAttack(const Perturbation<Scalar>& perturbation) : perturbation_(&perturbation) {}

  template <class AgentT>
  State perturb(State truth, const AgentT&, Stream& rng) const {
    const auto ball = perturbation_->ball(truth);
    return ball[static_cast<std::size_t>(rng.below(static_cast<int>(ball.size())))];
  }

 private:
  const Perturbation<Scalar>* perturbation_;
};

/// A stationary omega, e.g. the optimal attack on a fixed policy: shows attack[s]. Throws std::out_of_range in a state
/// that it has no answer for.
class FixedAttack {
 public:
  explicit FixedAttack(AttackPolicy attack) : attack_(std::move(attack)) {}

  template <class AgentT>
  State perturb(State truth, const AgentT&, Stream&) const {
    return attack_.at(static_cast<std::size_t>(truth));
  }

 private:
  AttackPolicy attack_;
};

/// The best response to the agent's next action, judged by a table (paper, Algorithm 1 line 6): shows
/// argmin_{t in B(s)} q(s, what the agent would do on seeing t). Against a stationary agent it is omega_pi; against an
/// agent with a belief it sees through the belief, but does not plan to mislead it.
template <class Scalar>
class MyopicAttack {
 public:
  MyopicAttack(QTable<Scalar> q, const Perturbation<Scalar>& perturbation, TieBreak tie = TieBreak::lowest_index)
      : q_(std::move(q)), perturbation_(&perturbation), tie_(tie) {}

  template <TransparentAgent AgentT>
  State perturb(State truth, const AgentT& agent, Stream&) const {
    const auto ball = perturbation_->ball(truth);
    const auto shown = internal::arg_best<std::size_t>(
        ball.size(), [&](std::size_t i) { return q_(truth, agent.would_do(ball[i])); },
        [](auto& x, auto& y) { return x < y; }, tie_);
    return ball[shown];
  }

 private:
  QTable<Scalar> q_;
  const Perturbation<Scalar>* perturbation_;
  TieBreak tie_;
};

/// Any attack, held to the rules: throws std::logic_error when it shows a state outside B(s), so that a broken attack
/// can never be reported as a strong one.
template <class AttackT, class Scalar>
class WithinBall {
 public:
  WithinBall(AttackT& attack, const Perturbation<Scalar>& perturbation)
      : attack_(&attack), perturbation_(&perturbation) {}

  void forget() {
    if constexpr (requires { attack_->forget(); }) attack_->forget();
  }

  template <class AgentT>
  requires Attack<AttackT, State, AgentT> State perturb(State truth, const AgentT& agent, Stream& rng) {
    const State shown = attack_->perturb(truth, agent, rng);
    if (perturbation_->contains(truth, shown)) return shown;
    throw std::logic_error("attack: showed state " + std::to_string(shown) + " when state " + std::to_string(truth) +
                           " was true, which is outside its ball");
  }

 private:
  AttackT* attack_;
  const Perturbation<Scalar>* perturbation_;
};

}  // namespace maximin
