#pragma once

#include <string>
#include <variant>

#include <torch/torch.h>

#include <maximin/theory/aggregators.hpp>

namespace maximin::deep {

/// How the values over a belief become one: the aggregators of the exact layer (theory/aggregators.hpp), on tensors and
/// with weights.
using AnyAggregator = std::variant<MinAggregator, MeanAggregator, SoftMinAggregator, CvarAggregator>;

/// "min", "mean", "soft-min:BETA" or "cvar:ALPHA". Throws InputError on anything else.
AnyAggregator aggregator_named(const std::string& text);
/// The name that `aggregator_named` reads.
std::string name_of(const AnyAggregator& aggregator);

/// Aggregates q [n, K, actions] over the K states of each belief, whose weights [n, K] sum to 1: -> [n, actions].
/// With equal weights each entry is what the exact layer's aggregator returns for those K values. A state of weight 0
/// counts for nothing, in the minimum neither.
torch::Tensor aggregate(const AnyAggregator& aggregator, const torch::Tensor& q, const torch::Tensor& weights);

}  // namespace maximin::deep
