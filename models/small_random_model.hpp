#pragma once

#include <maximin/models/model.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// A small random model for property tests, with a geometry. `size` >= 0 is how adventurous it may be: |S| is at most
/// 1 + size/10, and 2 to 8 from size 10 on.
///
/// Half of them are members of the campaign families. The others are made of small integers, where ties, absorbing
/// states, equal rows, zero rewards, gamma = 0 and balls of one state or of all live: distinct integer points, rewards
/// in {-3..3}, probabilities that are multiples of 1/4.
Model<double> small_random_model(int size, Stream& rng);

}  // namespace maximin
