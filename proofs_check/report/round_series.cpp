#include <maximin/proofs_check/report/round_series.hpp>

#include <algorithm>

#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

/// The bound of strengthening C at rounds 0 to rounds-1.
std::vector<double> finite_n_bounds(double gamma, double delta, const QTable<double>& optimal, std::size_t rounds) {
  const double d_0 = std::max(0.0, optimal.maxCoeff());
  const double u_0 = std::max(0.0, -optimal.minCoeff());
  std::vector<double> values(rounds);
  for (std::size_t n = 0; n < rounds; ++n) values[n] = bounds::finite_n(gamma, delta, d_0, u_0, static_cast<long>(n));
  return values;
}

}  // namespace

RoundSeries round_series(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                         const ExaminationOptions& options) {
  const ModelConstants<double> c = model_constants(mdp, perturbation.metric());
  if (!c.finite()) return {};
  const CertifiedSolution<double> optimal = policy_iteration(mdp);
  RoundSeries series;
  std::vector<double> gap_of_pair;
  PessimisticQIterationOptions<double> iteration;
  iteration.max_iterations = options.max_iterations;
  iteration.tie = options.tie;
  pessimistic_q_iteration<double>(
      mdp, perturbation, iteration, [&](long, const QTable<double>&, int pair, const PolicyPair& policies) {
        if (static_cast<std::size_t>(pair) == gap_of_pair.size()) {
          const auto robust = evaluate_against_optimal_attack(mdp, perturbation, policies.policy);
          gap_of_pair.push_back((optimal.q - robust.q).maxCoeff());
        }
        series.gap.push_back(gap_of_pair[static_cast<std::size_t>(pair)]);
      });
  const double gamma = mdp.discount(), eps = perturbation.radius();
  const double l = bounds::lipschitz_of_q(gamma, c.l_r.value, c.l_p.value, mdp.states(), c.r_max);
  const double l_tv = bounds::lipschitz_of_q_tv(gamma, c.l_r.value, c.k_tv.value, c.span);
  for (const auto& [id, lipschitz] : {std::pair(ClaimId::c_finite_n, l), std::pair(ClaimId::d_total_variation, l_tv)}) {
    if (!options.wants(id)) continue;
    series.bounds.emplace_back(
        id, finite_n_bounds(gamma, bounds::delta(eps, gamma, lipschitz), optimal.q, series.gap.size()));
  }
  return series;
}

}  // namespace maximin
