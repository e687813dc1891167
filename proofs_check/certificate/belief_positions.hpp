#pragma once

#include <optional>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/tabular/position_graph.hpp>

namespace maximin {

/// The game of the belief-maximin agent of the table q, with values that are exact for up to `max_exact_positions`
/// and exactly verified lower bounds for more. Of more than `max_positions` those reached first are listed; nothing
/// where not even all starts are.
std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const QTable<Rational>& q, const CertifyOptions& options);

/// The same of an agent that may take any of choices(M) on a belief M: always lower bounds, but where it has one
/// choice.
std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const internal::PositionGraph<Rational>::BeliefChoices& choices,
                                                       const CertifyOptions& options);

/// min_{t in B(s)} W(s, B(t)) for every true state s.
Values<Rational> start_values(const CertifiedBeliefGame& game, const Perturbation<Rational>& balls);

}  // namespace maximin
