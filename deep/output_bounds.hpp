#pragma once

#include <torch/torch.h>

#include <maximin/deep/q_network.hpp>

/// What a Q-network can say anywhere in a box of states.
///
/// Sound in floating point: each bound holds for the exact network, and for what `QNetwork::forward` computes in the
/// network's own precision at any point of the box whose coordinates are of that precision. For this each bound is
/// moved outwards by (number of terms + 8 per layer) times the machine's epsilon times the sum of the magnitudes that
/// are added up (Higham, "Accuracy and Stability of Numerical Algorithms", section 3.1, for any order of summation):
/// below 1e-4 of the magnitudes for 2-128-128-8 in float, 1e-13 in double. It presumes IEEE arithmetic, hence no TF32.
///
/// Differentiable in the network's weights; the margins count as constants.
namespace maximin::deep {

/// One box of states per row: low <= x <= high in each coordinate. Both [n, inputs].
struct StateBox {
  torch::Tensor low, high;
};

/// Where states can be at all: the Gridworld's [0,10] in each coordinate.
struct StateRange {
  double low = 0, high = 10;
};

/// The l-infinity ball of radius eps >= 0 around each state [n, inputs], clipped to the range. A positive radius is
/// widened by a few units in the last place, so that no point of the true ball is lost to rounding; with eps = 0 the
/// box is the (clipped) state alone. Throws InputError unless eps is finite and at least 0 and the range is not empty.
StateBox ball_around(const torch::Tensor& states, double eps, StateRange range = {});

/// How bounds are computed, from fast and wide to slow and narrow.
enum class BoundMethod {
  ibp,        ///< intervals through the layers (Gowal et al. 2018)
  crown_ibp,  ///< linear bounds of the outputs, from intervals of the hidden layers (Zhang et al. 2020)
  crown,      ///< linear bounds of every layer (Zhang et al. 2018), the hidden ones met with their intervals
  tightest,   ///< the better of `crown` and of the intervals that follow from its hidden layers
};

/// Bounds of all action values, [n, actions] each.
struct OutputBounds {
  torch::Tensor lower, upper;
};

/// lower <= Q(x, a) <= upper for all x in the box. Throws InputError when a box does not fit the network or is empty,
/// or the network is neither float nor double; so do the functions below.
OutputBounds output_bounds(const QNetwork& q, const StateBox& box, BoundMethod method);

/// Upper bounds of Q(x, a) - Q(x, reference) over the box, [n, actions], for one reference action per row ([n], int64).
/// The difference is merged into the last layer, which is never wider than upper(a) - lower(reference) and mostly much
/// narrower. Exactly 0 for the reference itself.
torch::Tensor difference_upper_bounds(const QNetwork& q, const StateBox& box, const torch::Tensor& reference,
                                      BoundMethod method);

/// Upper bounds of Q(x, a) - Q(x, b) over the box, [n, actions a, actions b], 0 on the diagonal.
torch::Tensor pairwise_difference_upper_bounds(const QNetwork& q, const StateBox& box, BoundMethod method);

/// Which actions may be greedy somewhere in the box, from bounds of the pairwise differences: a such that no b is
/// better everywhere. [n, actions], bool. Never empty, and never without an action that is greedy somewhere.
torch::Tensor possibly_greedy(const torch::Tensor& pairwise_upper_bounds);

}  // namespace maximin::deep
