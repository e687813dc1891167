#pragma once

#include <maximin/models/model.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// Garnet, "generalized average reward non-stationary environment test bench" (Archibald, McKinnon and Thomas, "On the
/// generation of Markov decision processes", 1995): every (s,a) leads to `branching` distinct random states, with the
/// probabilities that branching - 1 uniform cuts of [0,1] leave; R(s,a) is uniform on [0,1).
/// It has no points; distance is hops in the transition graph and eps is 1.
/// Throws InputError unless 1 <= branching <= states <= 10^6 and 1 <= actions <= 1000, and 0 <= discount < 1.
Model<double> garnet(State states, Action actions, State branching, double discount, Stream& rng);

}  // namespace maximin
