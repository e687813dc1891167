#pragma once

#include <functional>

#include <maximin/models/model.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

/// The family in which the smallest counterexamples are looked for, all of it: states that all look alike, gamma = 1/2,
/// rewards -2, -1, 0, 1 or 2, and each (state, action) leads to one state or to two by a fair coin. Models that differ
/// only in the order of their actions count once, and no action occurs twice.
///
/// They are visited by size: the sum of |R| plus the number of arrows to other states.
///
/// Calls `visit` with each until it returns true; returns how many it was called with.
long visit_tiny_models(State states, Action actions, const std::function<bool(const Model<Rational>&)>& visit);

/// sum |R| plus the number of arrows to other states.
Rational tiny_size(const FiniteMdp<Rational>& mdp);

}  // namespace maximin
