#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>

#include <maximin/theory/error.hpp>

namespace maximin {

/// How an agent turns the values of one action over its belief into one number. Minimum is the paper's pessimism;
/// the others are what deep-layer agents compare it with. All lie between the least and the greatest value.
///
/// An aggregator is a function object: `Scalar operator()(std::span<Scalar> values) const`, `values` not empty. It may
/// reorder the values; it may not allocate.
template <class A, class Scalar>
concept Aggregator = requires(const A& aggregate, std::span<Scalar> values) {
  { aggregate(values) } -> std::convertible_to<Scalar>;
};

/// The least value: the worst state in the belief (paper, Algorithm 1 line 5).
struct MinAggregator {
  template <class Scalar>
  Scalar operator()(std::span<Scalar> values) const {
    return *std::min_element(values.begin(), values.end());
  }
};

/// The greatest value: optimism, the paper's "best case".
struct MaxAggregator {
  template <class Scalar>
  Scalar operator()(std::span<Scalar> values) const {
    return *std::max_element(values.begin(), values.end());
  }
};

/// The plain average: every state of the belief equally likely.
struct MeanAggregator {
  template <class Scalar>
  Scalar operator()(std::span<Scalar> values) const {
    Scalar sum(0);
    for (const Scalar& v : values) sum += v;
    return sum / Scalar(static_cast<long>(values.size()));
  }
};

/// -1/beta log mean exp(-beta v): the mean for beta -> 0, the minimum for beta -> infinity. Floating point only.
class SoftMinAggregator {
 public:
  /// Throws InputError unless beta is finite and positive.
  explicit SoftMinAggregator(double beta) : beta_(beta) {
    if (!(beta > 0 && std::isfinite(beta))) throw InputError("soft-min: beta must be positive and finite, e.g. 1");
  }

  template <std::floating_point Scalar>
  Scalar operator()(std::span<Scalar> values) const {
    const Scalar least = *std::min_element(values.begin(), values.end());
    Scalar sum(0);
    for (const Scalar& v : values) sum += std::exp(static_cast<Scalar>(-beta_) * (v - least));
    return least - std::log(sum / static_cast<Scalar>(values.size())) / static_cast<Scalar>(beta_);
  }

  double beta() const { return beta_; }

 private:
  double beta_;
};

/// The mean of the worst fraction alpha of the values (conditional value at risk of the uniform belief): the minimum
/// for alpha -> 0, the mean for alpha = 1. The value on the boundary counts with the part of its weight that is inside.
class CvarAggregator {
 public:
  /// Throws InputError unless 0 < alpha <= 1.
  explicit CvarAggregator(double alpha) : alpha_(alpha) {
    if (!(alpha > 0 && alpha <= 1)) throw InputError("cvar: alpha must be above 0 and at most 1, e.g. 0.25");
  }

  template <std::floating_point Scalar>
  Scalar operator()(std::span<Scalar> values) const {
    std::sort(values.begin(), values.end());
    const Scalar mass = static_cast<Scalar>(alpha_) * static_cast<Scalar>(values.size());
    Scalar sum(0), taken(0);
    for (const Scalar& v : values) {
      const Scalar weight = std::min(Scalar(1), mass - taken);
      if (!(weight > Scalar(0))) break;
      sum += weight * v;
      taken += weight;
    }
    return sum / taken;
  }

  double alpha() const { return alpha_; }

 private:
  double alpha_;
};

}  // namespace maximin
