#pragma once

#include <maximin/models/model.hpp>

namespace maximin {

/// The chain (Strens, "A Bayesian framework for reinforcement learning", 2000, there with 5 states and slip 0.2):
/// states 0 to n-1 on a line. "forward" goes one state on, and pays 10 in the last state, where it stays; "back"
/// returns to state 0 and pays 2. With probability `slip` an action does what the other one would have. R(s,a) is the
/// expected payment. Points 0 to n-1, eps 1, start in state 0. Throws InputError unless 1 <= states <= 10^6, 0 <= slip
/// <= 1 and 0 <= discount < 1.
Model<double> chain(State states, double discount, double slip = 0.2);

}  // namespace maximin
