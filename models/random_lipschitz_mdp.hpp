#pragma once

#include <limits>
#include <optional>

#include <maximin/models/model.hpp>
#include <maximin/models/random_points.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The sign that the rewards of a random model have.
enum class RewardSign {
  mixed,        ///< an interval around 0
  nonnegative,  ///< min R = 0
  nonpositive,  ///< max R = 0: costs
};

/// What to ask of a random Lipschitz MDP. Distances are in units of the points.
struct LipschitzMdpOptions {
  State states = 10;      ///< |S|, 1 to 2000
  Action actions = 3;     ///< |A|, 1 to 1000
  double discount = 0.9;  ///< gamma in [0, 1)

  PointLayout layout = PointLayout::uniform;
  int dimension = 2;     ///< of the points, 1 to 16
  double side = 1;       ///< the points lie in [0, side]^dimension
  Norm norm = Norm::l2;  ///< turns points into distances
  double eps = 0.1;      ///< radius of the (closed) balls, >= 0

  double l_r = 1;                       ///< smallest Lipschitz constant of R (Assumption 1), >= 0
  RewardSign sign = RewardSign::mixed;  ///< of the rewards
  std::optional<double> reward_span;    ///< max R - min R; drawn if absent
  double action_gap = std::numeric_limits<double>::infinity();  ///< largest |R(s,a) - R(s,0)| allowed

  double l_p = 0.1;              ///< smallest Lipschitz constant of P (Assumption 1), >= 0
  State successors = 0;          ///< largest number of successors of a row, at least 2; 0 = dense
  double sharpness = 0.5;        ///< in [0,1]: how much of a row goes to one random state before l_p is imposed
  bool same_common_row = false;  ///< nu_a is the same for every a, so that where to go hardly depends on the action
};

/// A random MDP whose constants, recomputed by `model_constants`, are the requested l_r and l_p up to rounding
/// (relative error below 1e-9 as long as l_r and l_p are not below 1e-5 of the largest values that the points allow
/// for the drawn span).
///
/// Rewards: a random Lipschitz function per action, drawn state by state inside the interval that McShane's extension
/// theorem leaves open (so that every l_r-Lipschitz function is possible), after one pair was made to attain l_r.
/// Kernel: random rows P0, contracted towards one common row nu_a per action, P = (1-t) nu_a + t P0, which scales every
/// difference by t. If P0 falls short of l_p, its rows are first concentrated on one successor each until they attain
/// it. In a sparse model half of a row's successors are those of nu_a, half its own.
///
/// The same options and stream give the same model on every machine. Takes O(|S|^3 |A|) time.
///
/// Throws InputError on an option outside its range, and when a constant cannot be attained: l_p above 1/d_min, d_min
/// being the least distance between two of the points; a reward span that no function of constant l_r has; any positive
/// constant with a single state. The message states what can be reached.
Model<double> random_lipschitz_mdp(const LipschitzMdpOptions& options, Stream& rng);

/// The same on given points, one row per state; `layout`, `side` and `dimension` are then not used, and `states` must
/// be the number of points.
Model<double> random_lipschitz_mdp(Metric<double>::Points points, const LipschitzMdpOptions& options, Stream& rng);

}  // namespace maximin
