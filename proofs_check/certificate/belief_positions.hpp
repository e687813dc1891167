#pragma once

#include <optional>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>

namespace maximin {

/// The game of the belief-maximin agent of the table q on all its reachable positions, with values that are exact for
/// up to `max_exact_positions` and exactly verified lower bounds for more. Nothing where there are more than
/// `max_positions`.
std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const QTable<Rational>& q, const CertifyOptions& options);

/// min_{t in B(s)} W(s, B(t)) for every true state s.
Values<Rational> start_values(const CertifiedBeliefGame& game, const Perturbation<Rational>& balls);

}  // namespace maximin
