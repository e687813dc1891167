#pragma once

#include <maximin/proofs_check/certificate/boxes.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {

/// Constants of a model that are never too large: floating point finds the pair of states that attains each, or nearly,
/// and the quotient is taken there, exactly. In bounds that are right sides, such constants are safe.
struct Witnesses {
  ModelConstants<Rational> constants;
  LipschitzConstant<Rational> l_star;  ///< of Q*, from bounds on it
};

/// `low` and `high` are back of bounds on V*. Throws AssumptionFails where two states at distance 0 differ.
Witnesses find_witnesses(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry, const ScaledTable& low,
                         const ScaledTable& high);

}  // namespace maximin
