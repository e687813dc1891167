#include <maximin/models/random_lipschitz_rewards.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// A function on the states that is given on some and still to be drawn on the others.
struct Partial {
  Eigen::VectorXd value;
  std::vector<State> known;

  void set(State s, double v) {
    value[s] = v;
    known.push_back(s);
  }
};

struct Interval {
  double low, high;

  void meet(double l, double h) {
    low = std::max(low, l);
    high = std::min(high, h);
  }
};

/// Draws the function where it is not known, state by state in random order: by McShane's extension theorem a function
/// that is L-Lipschitz so far, with values in [0, span], has such an extension, and at the next state every value of
/// [max_k f(k) - L d, min_k f(k) + L d] is possible. A quarter of the draws fall on an end of it, which makes many
/// pairs attain L. `allowed(s)` may narrow [0, span].
template <class Allowed>
void extend(Partial& f, const PairwiseDistances& distances, double l_r, Allowed allowed, Stream& rng) {
  std::vector<State> order(static_cast<std::size_t>(distances.states()));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(rng.below(static_cast<int>(i)))]);
  }
  for (const State s : order) {
    if (std::find(f.known.begin(), f.known.end(), s) != f.known.end()) continue;
    Interval open = allowed(s);
    for (const State k : f.known) open.meet(f.value[k] - l_r * distances(s, k), f.value[k] + l_r * distances(s, k));
    const double share = std::clamp(rng.uniform(-1.0 / 6, 7.0 / 6), 0.0, 1.0);
    f.set(s, open.low + share * std::max(0.0, open.high - open.low));
  }
}

/// The state nearest to s and the state farthest from it.
struct Extremes {
  State nearest, farthest;
};

Extremes extremes_of(const PairwiseDistances& distances, State s) {
  Extremes e{s == 0 ? 1 : 0, s == 0 ? 1 : 0};
  for (State t = 0; t < distances.states(); ++t) {
    if (t == s) continue;
    if (distances(s, t) < distances(s, e.nearest)) e.nearest = t;
    if (distances(s, t) > distances(s, e.farthest)) e.farthest = t;
  }
  return e;
}

/// The pairs that make constant and span exact.
struct Anchors {
  double span;
  State low = 0, tight = 0, high = 0;  ///< f(low) = 0, f(tight) = l_r d(low, tight), f(high) = span
  bool high_elsewhere = false;         ///< the span is wider than l_r allows one action: another action attains it
};

[[noreturn]] void out_of_reach(const PairwiseDistances& distances, const LipschitzMdpOptions& o) {
  const double least = o.l_r * distances.least, most = o.l_r * distances.diameter;
  const bool shifts = o.actions > 1 && std::isinf(o.action_gap);
  throw InputError(fmt::format("reward_span: {} requested, expected {} on these points with l_r {}", *o.reward_span,
                               shifts ? fmt::format("at least {}", least) : fmt::format("{} to {}", least, most),
                               o.l_r));
}

/// Chooses where constant and span are attained. Without a requested span it is drawn between what the nearest and the
/// farthest state from a random one allow.
Anchors choose_anchors(const PairwiseDistances& distances, const LipschitzMdpOptions& o, Stream& rng) {
  const State n = distances.states();
  const bool shifts = o.actions > 1 && std::isinf(o.action_gap);
  const double slack = 1 + 1e-12;
  if (n == 1 || o.l_r == 0) {
    const double span = o.reward_span.value_or(shifts ? 1 : 0);
    if (span > 0 && !shifts) out_of_reach(distances, o);
    return {.span = span, .high_elsewhere = shifts};
  }
  const State first = rng.below(n);
  for (State i = 0; i < n; ++i) {
    const State low = (first + i) % n;
    const auto [nearest, farthest] = extremes_of(distances, low);
    const double least = o.l_r * distances(low, nearest), most = o.l_r * distances(low, farthest);
    const double span = o.reward_span.value_or(least + (most - least) * rng.uniform());
    if (span * slack < least || (span > most * slack && !shifts)) continue;
    return {span, low, nearest, farthest, span > most * slack};
  }
  out_of_reach(distances, o);
}

/// The function of action 0: from 0 to the span (unless another action attains that), with one pair that attains l_r.
Eigen::VectorXd anchored_function(const PairwiseDistances& distances, const Anchors& anchors, double l_r, Stream& rng) {
  Partial f{Eigen::VectorXd::Zero(distances.states()), {}};
  const double span = anchors.span;
  f.set(anchors.low, 0);
  if (anchors.tight != anchors.low) f.set(anchors.tight, std::min(span, l_r * distances(anchors.low, anchors.tight)));
  const bool high_is_new = anchors.high != anchors.low && anchors.high != anchors.tight;
  if (!anchors.high_elsewhere && high_is_new) f.set(anchors.high, span);
  extend(
      f, distances, l_r,
      [&](State) {
        return Interval{0, span};
      },
      rng);
  if (!anchors.high_elsewhere && rng.chance(0.5)) f.value = (span - f.value.array()).matrix();
  return f.value;
}

}  // namespace

QTable<double> random_lipschitz_rewards(const PairwiseDistances& distances, const LipschitzMdpOptions& options,
                                        Stream& rng) {
  const State n = distances.states();
  if (n == 1 && options.l_r > 0) {
    throw InputError(fmt::format("l_r: {} requested, expected 0, the largest there is with one state", options.l_r));
  }
  const Anchors anchors = choose_anchors(distances, options, rng);
  QTable<double> rewards(n, options.actions);
  rewards.col(0) = anchored_function(distances, anchors, options.l_r, rng);
  const double span = anchors.span, gap = options.action_gap;
  for (Action a = 1; a < options.actions; ++a) {
    Partial f{Eigen::VectorXd::Zero(n), {}};
    if (anchors.high_elsewhere && a == 1) f.set(rng.below(n), span);
    extend(
        f, distances, options.l_r,
        [&](State s) {
          Interval open{0, span};
          open.meet(rewards(s, 0) - gap, rewards(s, 0) + gap);
          return open;
        },
        rng);
    rewards.col(a) = f.value;
  }
  if (options.sign == RewardSign::mixed) rewards.array() -= span * rng.uniform();
  if (options.sign == RewardSign::nonnegative) rewards.array() -= rewards.minCoeff();
  if (options.sign == RewardSign::nonpositive) rewards.array() -= rewards.maxCoeff();
  return rewards;
}

}  // namespace maximin
