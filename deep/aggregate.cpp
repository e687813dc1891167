#include <maximin/deep/aggregate.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

double parameter_of(const std::string& text, std::size_t colon) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data() + colon + 1, end, value);
  if (error != std::errc() || stopped != end || !std::isfinite(value)) {
    throw InputError(fmt::format("aggregator: {}, expected a number after the colon, e.g. cvar:0.25", text));
  }
  return value;
}

torch::Tensor of(const MinAggregator&, const torch::Tensor& q, const torch::Tensor& weights) {
  return q.masked_fill((weights <= 0).unsqueeze(-1), std::numeric_limits<float>::infinity()).amin(1);
}

torch::Tensor of(const MeanAggregator&, const torch::Tensor& q, const torch::Tensor& weights) {
  return torch::bmm(weights.unsqueeze(1), q).squeeze(1);
}

// In double: for a small beta the logarithm is of a number near 1, for a large one the exponents leave the floats.
torch::Tensor of(const SoftMinAggregator& soft, const torch::Tensor& q, const torch::Tensor& weights) {
  const torch::Tensor w = weights.unsqueeze(-1).to(torch::kDouble);
  const torch::Tensor values = q.to(torch::kDouble).masked_fill(w <= 0, std::numeric_limits<double>::infinity());
  const torch::Tensor least = values.amin(1, true);
  // Weights that are floats sum to 1 but nearly, and a small beta would make much of that.
  const torch::Tensor mean = (w * torch::exp((values - least) * -soft.beta())).sum(1) / w.sum(1);
  return (least.squeeze(1) - mean.log() / soft.beta()).to(q.scalar_type());
}

// The worst values first, each with the part of its weight that still fits into alpha.
torch::Tensor of(const CvarAggregator& cvar, const torch::Tensor& q, const torch::Tensor& weights) {
  const auto [sorted, order] = q.sort(1);
  const torch::Tensor w = weights.unsqueeze(-1).expand_as(q).gather(1, order);
  const torch::Tensor before = w.cumsum(1) - w;
  // A share that is no number above 0 among floats would take nothing at all.
  const double alpha = std::max(cvar.alpha(), 1e-30);
  const torch::Tensor taken = torch::minimum(w, (alpha - before).clamp_min(0));
  return (taken * sorted).sum(1) / taken.sum(1);
}

}  // namespace

AnyAggregator aggregator_named(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  if (text == "min") return MinAggregator{};
  if (text == "mean") return MeanAggregator{};
  if (colon != std::string::npos && kind == "soft-min") return SoftMinAggregator(parameter_of(text, colon));
  if (colon != std::string::npos && kind == "cvar") return CvarAggregator(parameter_of(text, colon));
  throw InputError(fmt::format("aggregator: {}, expected min, mean, soft-min:BETA or cvar:ALPHA", text));
}

std::string name_of(const AnyAggregator& aggregator) {
  if (std::holds_alternative<MinAggregator>(aggregator)) return "min";
  if (std::holds_alternative<MeanAggregator>(aggregator)) return "mean";
  if (const auto* soft = std::get_if<SoftMinAggregator>(&aggregator)) return fmt::format("soft-min:{}", soft->beta());
  return fmt::format("cvar:{}", std::get<CvarAggregator>(aggregator).alpha());
}

torch::Tensor aggregate(const AnyAggregator& aggregator, const torch::Tensor& q, const torch::Tensor& weights) {
  if (q.size(1) == 1) return q.squeeze(1);
  return std::visit([&](const auto& kind) { return of(kind, q, weights); }, aggregator);
}

}  // namespace maximin::deep
