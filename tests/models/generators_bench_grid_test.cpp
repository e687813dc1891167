#include <gtest/gtest.h>

#include <maximin/models/bench_instances.hpp>
#include <maximin/tabular/value_iteration.hpp>

namespace maximin::bench {
namespace {

/// A million states; the agreed answer has twelve digits.
TEST(BenchInstances, Grid) {
  SolverOptions options;
  options.tolerance = 1e-11;
  EXPECT_NEAR(value_iteration(grid_instance(1000, 1000, 0.95, 7), options).v[0], -2.62310294622, 1e-9);
}

}  // namespace
}  // namespace maximin::bench
