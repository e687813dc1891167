#pragma once

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>

namespace maximin {

/// Q* and V* one strongly connected component of the transition graph at a time, successors first (Dai, Mausam, Weld
/// and Goldsmith, "Topological value iteration algorithms", 2011). When the turn of a component comes, all values that
/// it can lead to outside itself are known, so that each part of the model is solved once: a state on no cycle by one
/// backup, a state whose only cycle is its own loop by a division, a larger component as a small MDP of its own. Fast
/// on models with a direction (mazes with absorbing goals, chains, episodes); no slower than policy iteration on a
/// model that is one component.
///
/// The component-wise solutions are not trusted to compose: the whole is certified by MacQueen's bounds, after further
/// sweeps if need be, like that of every other solver. `sweeps` counts what was done in passes over the whole model,
/// rounded up. Throws BudgetExhausted when the certificate is not reached.
template <class Scalar>
CertifiedSolution<Scalar> topological_value_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options = {});

}  // namespace maximin
