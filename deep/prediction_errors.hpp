#pragma once

#include <cstdint>

#include <maximin/deep/belief_model.hpp>
#include <maximin/deep/wandering.hpp>
#include <maximin/gridworld/box_union.hpp>

namespace maximin::deep {

/// Where a belief model is judged.
struct PredictionTrial {
  double eps = 0.1;
  Walk walk = Walk::mixed;
  Deception deception = Deception::uniform;
  long episodes = 64;  ///< all in step
  long horizon = 100;
  /// Other than that of the training, lest the belief be judged by what it has learned from.
  std::uint64_t seed = 1'000'003;
};

/// What came of it, as means over all steps. Distances are Euclidean, areas those of the world, 100.
struct PredictionErrors {
  long steps = 0;
  double belief = 0;      ///< distance from the belief's weighted mean to the truth
  double exact = 0;       ///< from the centroid of the exact belief
  double shown = 0;       ///< from what is shown
  double nearest = 0;     ///< from the nearest of the belief's states
  double holds = 0;       ///< share of steps in which the belief holds the truth; the exact one always does
  double inside = 0;      ///< weight of the states that are in the exact belief: that are possible
  double size = 0;        ///< area of the belief
  double exact_size = 0;  ///< area of the exact belief
  long empty = 0;         ///< how often prediction and observation did not meet
};

/// Plays and compares with the exact filter of gridworld/box_belief.hpp. The belief is resized, its memory lost.
PredictionErrors evaluate_predictions(LaneBelief& belief, const PredictionTrial& trial);

/// The centroid of a set that is not empty.
Point centroid(const BoxUnion& set);

}  // namespace maximin::deep
