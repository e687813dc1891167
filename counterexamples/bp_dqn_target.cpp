#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bellman.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  enum : Action { stay, go, actions };
  FiniteMdpBuilder<Rational> b(2, actions, Rational(1, 2));
  b.reward(0, stay, 1).reward(1, stay, 3).reward(1, go, 3);
  b.transition(0, stay, 0, 1).transition(0, go, 1, 1).transition(1, stay, 1, 1).transition(1, go, 1, 1);
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = Rational(0);
  model.name = "bp-dqn-target";
  model.state_names = {"here", "there"};
  model.action_names = {"stay", "go"};
  return model;
}

/// Where max_a min_{m in M} q(m,a) is read.
struct Read {
  State state;
  Action action;

  friend bool operator==(const Read&, const Read&) = default;
};

Read maximin_at(const QTable<Rational>& q, std::span<const State> belief, std::vector<Rational>& scratch) {
  const Action a = belief_action(q, belief, scratch);
  State worst = belief.front();
  for (const State m : belief) {
    if (q(m, a) < q(worst, a)) worst = m;
  }
  return {worst, a};
}

/// Which belief the target of (s,a,s') takes its maximin over.
enum class Bootstrap { belief_before, belief_after };

/// Tabular iteration of the target of BP-DQN, R + gamma max_a' min_{m in M} Q(m,a'), with the belief that an agent
/// holds who is shown the truth and remembers nothing: M = B(s) before the step (as printed), B(s') after it.
class TargetIteration {
 public:
  TargetIteration(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, Bootstrap bootstrap)
      : mdp_(mdp), balls_(balls), bootstrap_(bootstrap) {}

  /// The fixed point. The iteration is a gamma-contraction, so there is one and all starts lead there. It is found by
  /// solving for where the maximin is read now until the places stay: the solution is then checked by a backup.
  QTable<Rational> fixed_point() {
    QTable<Rational> q = mdp_.rewards();
    for (int round = 0; round < max_rounds; ++round) {
      const std::vector<Read> reads = places(q);
      QTable<Rational> next = solve(reads);
      if (places(next) == reads || backup_of(next) == next) return next;
      // A few plain backups: the places of the fixed point are those of any table near enough to it.
      for (int i = 0; i < backups_per_round; ++i) q = backup_of(q);
    }
    throw BudgetExhausted("bp-dqn-target: the fixed point was not found, expected a model without ties");
  }

 private:
  std::vector<Read> places(const QTable<Rational>& q) {
    std::vector<Read> result;
    for (State s = 0; s < mdp_.states(); ++s) result.push_back(maximin_at(q, balls_.ball(s), scratch_));
    return result;
  }

  /// R(s,a) + gamma U(s), or gamma sum P(s'|s,a) U(s'), U(s) = max_a min_{m in B(s)} Q(m,a).
  QTable<Rational> backup_with(const Values<Rational>& u) const {
    QTable<Rational> q(mdp_.states(), mdp_.actions());
    for (State s = 0; s < mdp_.states(); ++s) {
      for (Action a = 0; a < mdp_.actions(); ++a) {
        const Rational next = bootstrap_ == Bootstrap::belief_before ? u[s] : mdp_.expectation(s, a, u);
        q(s, a) = mdp_.reward(s, a) + mdp_.discount() * next;
      }
    }
    return q;
  }

  QTable<Rational> backup_of(const QTable<Rational>& q) {
    const std::vector<Read> reads = places(q);
    Values<Rational> u(mdp_.states());
    for (State s = 0; s < mdp_.states(); ++s) {
      const Read& read = reads[static_cast<std::size_t>(s)];
      u[s] = q(read.state, read.action);
    }
    return backup_with(u);
  }

  /// The table whose U(s) is read at reads[s].
  QTable<Rational> solve(const std::vector<Read>& reads) const {
    ExactSystem system{mdp_.discount(), {}, {}};
    for (const Read& read : reads) {
      system.rewards.push_back(mdp_.reward(read.state, read.action));
      const auto row = mdp_.successors(read.state, read.action);
      if (bootstrap_ == Bootstrap::belief_before) {
        system.rows.push_back({{read.state, Rational(1)}});
      } else {
        system.rows.emplace_back(row.begin(), row.end());
      }
    }
    return backup_with(solve_exactly(system));
  }

  static constexpr int max_rounds = 100;
  static constexpr int backups_per_round = 8;

  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  Bootstrap bootstrap_;
  std::vector<Rational> scratch_;
};

/// What its maximin policy is worth when nobody attacks.
Values<Rational> worth(const Model<Rational>& model, const Perturbation<Rational>& balls, const QTable<Rational>& q,
                       Policy& policy) {
  std::vector<Rational> scratch;
  maximin_policy(q, balls, policy, scratch);
  return solve_policy_values(model.mdp, policy);
}

Counterexample::Finding check(const Model<Rational>& model) {
  const auto balls = make_perturbation(model);
  const auto fixed_point = [&](Bootstrap b) { return TargetIteration(model.mdp, balls, b).fixed_point(); };
  const QTable<Rational> printed = fixed_point(Bootstrap::belief_before),
                         repaired = fixed_point(Bootstrap::belief_after);
  Eigen::Index s = 0, a = 0;
  const Rational off = (printed - repaired).cwiseAbs().maxCoeff(&s, &a);
  const auto at = [&](const char* whose) {
    return fmt::format("Q({}, {}) by the {} target", model.state_name(static_cast<State>(s)),
                       model.action_name(static_cast<Action>(a)), whose);
  };
  Policy by_printed, by_repaired;
  const Values<Rational> printed_worth = worth(model, balls, printed, by_printed);
  const Values<Rational> repaired_worth = worth(model, balls, repaired, by_repaired);
  Counterexample::Finding finding{{at("repaired"), repaired(s, a)}, {at("printed"), printed(s, a)}, off != 0, {}};
  finding.evidence.push_back(fmt::format("printed target: plays {}; worth {}", policy_text(model, by_printed),
                                         exact_text(model, printed_worth)));
  finding.evidence.push_back(fmt::format("repaired target: plays {}; worth {}", policy_text(model, by_repaired),
                                         exact_text(model, repaired_worth)));
  if (balls.largest_ball() == 1) {
    const bool optimal = repaired == policy_iteration(model.mdp).q;
    finding.evidence.push_back(
        fmt::format("nothing is perturbed; the repaired target gives Q*: {}", optimal ? "yes" : "no"));
  }
  return finding;
}

}  // namespace

Counterexample bp_dqn_target() {
  return {
      .name = "bp-dqn-target",
      .title = "The printed target of BP-DQN bootstraps from the wrong belief",
      .claim =
          "The target of BP-DQN as printed, R_t + gamma max_a' min_{m in M_t} Q'(m,a'), has the right fixed point.",
      .explanation =
          "M_t is the belief of s_t, but the value wanted is that of s_{t+1}, whose belief is M_{t+1}. Take eps = 0, "
          "so\n"
          "that nothing is perturbed and M_t = {s_t}: the printed target becomes R + gamma max_a' Q(s_t,a'), in which "
          "the\n"
          "next state does not occur at all. Every state is valued as if one stayed there for ever. Here staying pays "
          "1 a\n"
          "step and going pays 3 from the next step on; the printed target stays, worth 2, where going is worth 3. "
          "With\n"
          "M_{t+1} in its place the fixed point is Q*. Both iterations contract: each has one fixed point, from any "
          "start.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
