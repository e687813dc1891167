#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <maximin/deep/aggregate.hpp>
#include <maximin/theory/aggregators.hpp>
#include <maximin/theory/random.hpp>

#include "input_errors.hpp"

namespace maximin::deep::aggregate_test {  // of its own: built as one unit with its neighbours
namespace {

using torch::Tensor;
using Aggregation = std::function<Tensor(const AnyAggregator&, const Tensor&, const Tensor&)>;

/// What the exact layer's aggregator says of the values, each as often as its weight says.
double reference(const AnyAggregator& aggregator, const Tensor& values, const std::vector<int>& copies) {
  std::vector<double> repeated;
  for (std::size_t k = 0; k < copies.size(); ++k) {
    repeated.insert(repeated.end(), static_cast<std::size_t>(copies[k]), values[static_cast<long>(k)].item<double>());
  }
  return std::visit([&](const auto& exact) { return exact(std::span<double>(repeated)); }, aggregator);
}

/// The greatest difference from the exact layer in random beliefs, among them states of weight 0 and equal values.
double worst_difference(const Aggregation& aggregation, const std::vector<std::string>& names, torch::Dtype type) {
  Stream rng(5);
  double worst = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const AnyAggregator aggregator =
        aggregator_named(names[static_cast<std::size_t>(rng.below(static_cast<int>(names.size())))]);
    const long n = 1 + rng.below(3), k = 1 + rng.below(9), actions = 1 + rng.below(4);
    Tensor q = torch::zeros({n, k, actions}, torch::kDouble), weights = torch::zeros({n, k}, torch::kDouble);
    std::vector<std::vector<int>> copies(static_cast<std::size_t>(n));
    for (long row = 0; row < n; ++row) {
      auto& c = copies[static_cast<std::size_t>(row)];
      int sum = 0;
      for (long i = 0; i < k; ++i) sum += c.emplace_back(k == 1 ? 1 : rng.below(4));
      if (sum == 0) sum = c[0] = 2;
      for (long i = 0; i < k; ++i) {
        weights[row][i] = static_cast<double>(c[static_cast<std::size_t>(i)]) / sum;
        for (long a = 0; a < actions; ++a) q[row][i][a] = rng.chance(0.3) ? 1.0 : rng.uniform(-4, 4);
      }
    }
    q = q.to(type);
    const Tensor got = aggregation(aggregator, q, weights.to(type)).to(torch::kDouble);
    if (got.dim() != 2 || got.size(0) != n || got.size(1) != actions) return std::numeric_limits<double>::infinity();
    for (long row = 0; row < n; ++row) {
      for (long a = 0; a < actions; ++a) {
        const double wanted = reference(aggregator, q[row].select(1, a), copies[static_cast<std::size_t>(row)]);
        const double difference = std::abs(got[row][a].item<double>() - wanted);
        worst = difference <= worst ? worst : difference;  // also where it is no number
      }
    }
  }
  return worst;
}

const std::vector<std::string> all{"min",      "mean",          "soft-min:1", "soft-min:0.001",
                                   "cvar:0.5", "soft-min:1000", "cvar:1",     "cvar:0.25"};

TEST(Aggregate, IsWhatTheExactLayerSays) {
  EXPECT_LT(worst_difference(&aggregate, all, torch::kDouble), 1e-9);
  EXPECT_LT(worst_difference(&aggregate, all, torch::kFloat), 2e-5);

  // The check notices weights that are not looked at, a minimum over what is impossible, values that are not in order,
  // and a soft minimum that loses its digits.
  const auto equal_weights = [](const AnyAggregator& a, const Tensor& q, const Tensor& w) {
    return aggregate(a, q, torch::full_like(w, 1.0 / static_cast<double>(w.size(1))));
  };
  const auto over_everything = [](const AnyAggregator&, const Tensor& q, const Tensor&) { return q.amin(1); };
  const auto unsorted = [](const AnyAggregator& a, const Tensor& q, const Tensor& w) {
    const double alpha = std::get<CvarAggregator>(a).alpha();
    const Tensor taken = torch::minimum(w, (alpha - (w.cumsum(1) - w)).clamp_min(0)).unsqueeze(-1);
    return (taken * q).sum(1) / taken.sum(1);
  };
  const auto in_floats = [](const AnyAggregator& a, const Tensor& q, const Tensor& w) {
    const double beta = std::get<SoftMinAggregator>(a).beta();
    return torch::logsumexp(w.log().unsqueeze(-1) - beta * q, 1) / -beta;
  };
  EXPECT_GT(worst_difference(equal_weights, {"mean"}, torch::kDouble), 0.1);
  EXPECT_GT(worst_difference(over_everything, {"min"}, torch::kDouble), 0.1);
  EXPECT_GT(worst_difference(unsorted, {"cvar:0.5"}, torch::kDouble), 0.1);
  EXPECT_GT(worst_difference(in_floats, {"soft-min:0.001"}, torch::kFloat), 2e-5);
}

TEST(Aggregate, ExtremeParametersAndNames) {
  const Tensor q = torch::tensor({{{3.0F, -2.0F}, {-1.0F, 5.0F}, {-9.0F, -9.0F}}}),
               w = torch::tensor({{0.5F, 0.5F, 0.F}});
  for (const char* name : {"min", "cvar:1e-300", "cvar:1e-40", "soft-min:1e300", "soft-min:1e40"}) {
    EXPECT_TRUE(aggregate(aggregator_named(name), q, w).equal(torch::tensor({{-1.0F, -2.0F}}))) << name;
  }
  const AnyAggregator gentle = aggregator_named("soft-min:1e-9");
  EXPECT_TRUE(torch::allclose(aggregate(gentle, q, w), torch::tensor({{1.0F, 1.5F}}), 0, 1e-5));

  Stream rng(2);
  std::vector<std::string> names{"min",    "mean",     "soft-min:1", "soft-min:0.001", "soft-min:1e+300",
                                 "cvar:1", "cvar:0.25"};
  for (int i = 0; i < 200; ++i) {
    names.push_back(name_of(SoftMinAggregator(std::exp(rng.uniform(-30, 30)))));
    names.push_back(name_of(CvarAggregator(rng.uniform(1e-9, 1))));
  }
  for (const std::string& name : names) EXPECT_EQ(name_of(aggregator_named(name)), name);
  for (const std::string name :
       {"",           "Min",         "max",          "min:1",        "mean:",          "soft-min", "soft-min:",
        "soft-min:0", "soft-min:-1", "soft-min:inf", "soft-min:nan", "soft-min:1e999", "cvar",     "cvar:0",
        "cvar:1.5",   "cvar:nan",    "cvar:0.25x",   "cvar: 0.25",   "cvar:0,25",      "cvar:1:2", "cvar:-0.5"}) {
    EXPECT_TRUE(is_refusal(refusal([&] { aggregator_named(name); }))) << name;
  }
}

}  // namespace
}  // namespace maximin::deep::aggregate_test
