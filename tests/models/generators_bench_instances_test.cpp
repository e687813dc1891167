#include <gtest/gtest.h>

#include <maximin/models/bench_instances.hpp>
#include <maximin/tabular/value_iteration.hpp>

namespace maximin::bench {
namespace {

/// The first outputs of SplitMix64 from seed 1234567, as published with the generator's reference implementation.
TEST(SplitMix64, KnownAnswers) {
  SplitMix64 rng(1234567);
  EXPECT_EQ(rng.next(), 6457827717110365317u);
  EXPECT_EQ(rng.next(), 3203168211198807973u);
  EXPECT_EQ(rng.next(), 9817491932198370423u);
}

TEST(BenchInstances, SmallGridByHand) {
  const auto mdp = grid_instance(2, 2, 0.9, 3);
  const auto row = mdp.successors(0, 1);  // east from the corner: 0.8 east, 0.1 south, 0.1 north, off the board
  ASSERT_EQ(row.size(), 3u);
  EXPECT_EQ(row[0], (Successor<double>{0, 0.1}));
  EXPECT_EQ(row[1], (Successor<double>{1, 0.8}));
  EXPECT_EQ(row[2], (Successor<double>{2, 0.1}));
  const auto stuck = mdp.successors(0, 0);  // north: 0.8 + 0.1 (west) stay
  ASSERT_EQ(stuck.size(), 2u);
  EXPECT_EQ(stuck[0], (Successor<double>{0, 0.8 + 0.1}));
  EXPECT_EQ(mdp.successors(3, 2)[0], (Successor<double>{3, 1.0}));
  EXPECT_EQ(mdp.reward(3, 0), 0);
  SplitMix64 rng(3);
  EXPECT_EQ(mdp.reward(0, 0), -rng.u01());
  EXPECT_EQ(mdp.reward(0, 1), -rng.u01());
}

/// The agreed answers of the instances; another value means another instance.
TEST(BenchInstances, DenseBatch) {
  double sum = 0;
  for (std::uint64_t k = 0; k < 100; ++k) sum += value_iteration(dense_instance(200, 5, 0.9, 1000 + k)).v[0];
  EXPECT_NEAR(sum, 833.962453666, 5e-9);
}

TEST(BenchInstances, Sparse) {
  EXPECT_NEAR(value_iteration(sparse_instance(20000, 5, 10, 0.95, 42)).v[0], 16.9964558178878, 1e-10);
}

TEST(BenchInstances, RejectWhatTheyCannotBe) {
  EXPECT_THROW(sparse_instance(3, 1, 4, 0.9, 1), InputError);
  EXPECT_THROW(grid_instance(0, 3, 0.9, 1), InputError);
  EXPECT_THROW(grid_instance(100'000, 100'000, 0.9, 1), InputError);
}

}  // namespace
}  // namespace maximin::bench
