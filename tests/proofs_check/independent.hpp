#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include <maximin/theory/bellman.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>

#include "../tabular/reference.hpp"

/// Both sides of the claims once more, from their statements: rounds by theory/bellman.hpp, values by elimination and
/// plain sweeps in long double, constants from dense rows, bounds typed out. Shares nothing with `examine`.
namespace maximin::independent {

using reference::Real;

/// Lipschitz constant of the table, infinite where twins differ.
template <class Table>
double lipschitz(const Table& q, const Metric<double>& metric) {
  double constant = 0;
  for (State s = 0; s < q.rows(); ++s) {
    for (State t = 0; t < s; ++t) {
      const auto difference = static_cast<double>((q.row(s) - q.row(t)).cwiseAbs().maxCoeff());
      if (difference > 0) constant = std::max(constant, difference / metric.distance(s, t));
    }
  }
  return constant;
}

struct Constants {
  double l_r = 0, l_p = 0, k = 0, r_max = 0, span = 0;
  bool finite() const { return std::isfinite(l_r) && std::isfinite(l_p); }
};

inline Constants constants(const FiniteMdp<double>& mdp, const Metric<double>& metric) {
  Constants c;
  c.l_r = lipschitz(mdp.rewards(), metric);
  c.r_max = mdp.rewards().cwiseAbs().maxCoeff();
  c.span = mdp.rewards().maxCoeff() - mdp.rewards().minCoeff();
  for (Action a = 0; a < mdp.actions(); ++a) {
    QTable<double> p = QTable<double>::Zero(mdp.states(), mdp.states());
    for (State s = 0; s < mdp.states(); ++s) {
      for (const auto& next : mdp.successors(s, a)) p(s, next.target) = next.probability;
    }
    c.l_p = std::max(c.l_p, lipschitz(p, metric));
    for (State s = 0; s < mdp.states(); ++s) {
      for (State t = 0; t < s; ++t) {
        const double tv = (p.row(s) - p.row(t)).cwiseAbs().sum() / 2;
        if (tv > 0) c.k = std::max(c.k, tv / metric.distance(s, t));
      }
    }
  }
  return c;
}

/// One model with everything that the right sides need.
struct Subject {
  const FiniteMdp<double>& mdp;
  const Perturbation<double>& balls;
  Constants c = constants(mdp, balls.metric());
  QTable<Real> q_star = reference::optimal(mdp);
  double g = mdp.discount();
  double eps = balls.radius();
  double scale = static_cast<double>(reference::scale(mdp));
  double slack = 1e-10 * scale;

  double n_states() const { return mdp.states(); }
  double l_printed() const { return c.l_r + n_states() * c.l_p * c.r_max / (1 - g); }
  double l_repaired() const { return c.l_r + g * n_states() * c.l_p * c.r_max / (1 - g); }
  double l_tv() const { return c.l_r + g * c.k * c.span / (1 - g); }
  double delta(double l) const { return 2 * eps * g * l; }
  double d_0() const { return std::max(0.0, static_cast<double>(q_star.maxCoeff())); }
  double u_0() const { return std::max(0.0, static_cast<double>(-q_star.minCoeff())); }

  /// What Theorem 1, A and B say of the limit superior.
  double theorem_1() const { return (1 + g) / ((1 - g) * (1 - g)) * delta(l_printed()); }
  double one_sided() const { return delta(l_printed()) / ((1 - g) * (1 - g)); }
  /// Strengthening C, with the Delta of L.
  double finite_n(double l, long n) const {
    const double decay = std::pow(g, static_cast<double>(n));
    return (g * (decay * (d_0() + u_0()) + delta(l) * (1 - decay) / (1 - g)) + delta(l)) / (1 - g);
  }
  /// How far round n may still be from the limit: what C has beyond B.
  double transient(long n) const { return std::pow(g, static_cast<double>(n + 1)) * (d_0() + u_0()) / (1 - g); }
};

/// max (Q* - Q^{pi_n, attacker}), each policy worked out once.
class Gaps {
 public:
  explicit Gaps(const Subject& subject) : subject_(subject) {}

  /// Against omega_n.
  double pair(const Policy& composed) {
    return known(pairs_, composed, [&] { return reference::of_pair(subject_.mdp, composed); });
  }
  /// Against the optimal attacker of pi_n.
  double robust(const Policy& policy) {
    return known(policies_, policy, [&] { return reference::attacked(subject_.mdp, subject_.balls, policy); });
  }

 private:
  template <class Make>
  double known(std::map<Policy, double>& gaps, const Policy& key, Make make) {
    const auto [entry, is_new] = gaps.try_emplace(key, 0.0);
    if (is_new) entry->second = static_cast<double>((subject_.q_star - make()).maxCoeff());
    return entry->second;
  }

  const Subject& subject_;
  std::map<Policy, double> pairs_, policies_;
};

/// Plays `rounds` rounds of pessimistic Q-iteration from Q_0 = 0 and calls visit(n, Q_n, step, Q_{n+1}) for each.
template <class Visit>
void play(const Subject& subject, long rounds, TieBreak tie, Visit visit) {
  QTable<double> q = QTable<double>::Zero(subject.mdp.states(), subject.mdp.actions()), next;
  PessimisticStep<double> step;
  for (long n = 0; n < rounds; ++n) {
    pessimistic_update(subject.mdp, subject.balls, q, step, next, tie);
    visit(n, q, step, next);
    q.swap(next);
  }
}

/// Rounds after which the transient is beneath notice, and a few more for a cycle to come round.
inline long rounds_until_settled(double gamma) {
  return gamma <= 0 ? 10 : 20 + static_cast<long>(std::log(1e-11) / std::log(gamma));
}

}  // namespace maximin::independent
