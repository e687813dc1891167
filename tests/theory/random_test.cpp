#include <maximin/theory/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace maximin {
namespace {

/// Published with the algorithm (Random123, kat_vectors).
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

std::vector<std::uint64_t> draws(Stream rng, int count) {
  std::vector<std::uint64_t> list;
  for (int i = 0; i < count; ++i) list.push_back(rng());
  return list;
}

TEST(Stream, IsAFunctionOfSeedTrialAndDraw) {
  EXPECT_EQ(draws(Stream(5, 17), 100), draws(Stream(5, 17), 100));
  EXPECT_NE(draws(Stream(5, 17), 100), draws(Stream(6, 17), 100));
  EXPECT_NE(draws(Stream(5, 17), 100), draws(Stream(5, 18), 100));
  EXPECT_EQ(draws(Stream(5), 10), draws(Stream(5, 0), 10));
  // The first draw of seed 0, trial 0 is the first known answer.
  EXPECT_EQ(Stream(0)(), (std::uint64_t{0xe169c58d} << 32) | 0x6627e8d5);
}

/// Golden numbers: a change of any of them changes every campaign that anyone has ever run.
TEST(Stream, GoldenDraws) {
  Stream rng(2024, 7);
  EXPECT_EQ(rng(), 0x58bad16e47908b1cu);
  EXPECT_EQ(rng.below(1000), 756);
  EXPECT_EQ(rng.uniform(), 0x1.19a4afb80ea0fp-1);
  EXPECT_EQ(rng.integer(-5, 5), -5);
}

TEST(Stream, NoTwoDrawsOfManyStreamsAgree) {
  std::set<std::uint64_t> seen;
  std::size_t count = 0;
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32, ~std::uint64_t{0}}) {
    for (const std::uint64_t trial : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 32}) {
      for (const std::uint64_t x : draws(Stream(seed, trial), 500)) {
        seen.insert(x);
        ++count;
      }
    }
  }
  EXPECT_EQ(seen.size(), count) << "the high halves of seed and trial must count too";
}

TEST(Stream, UniformNumbersAreInTheirInterval) {
  Stream rng(1);
  double least = 1, largest = 0, sum = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const double u = rng.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    ASSERT_EQ(u * 0x1p53, std::floor(u * 0x1p53));
    least = std::min(least, u);
    largest = std::max(largest, u);
    sum += u;
  }
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(largest, 1 - 1e-3);
  EXPECT_NEAR(sum / count, 0.5, 5 * std::sqrt(1.0 / 12 / count));
  for (int i = 0; i < 1000; ++i) {
    const double x = rng.uniform(-3, -1);
    ASSERT_TRUE(x >= -3 && x < -1);
  }
}

TEST(Stream, DiceAreFair) {
  Stream rng(2);
  std::array<int, 6> faces{};
  constexpr int throws = 60'000;
  for (int i = 0; i < throws; ++i) ++faces[static_cast<std::size_t>(rng.below(6))];
  double chi_squared = 0;
  for (const int count : faces) chi_squared += (count - 10'000.0) * (count - 10'000.0) / 10'000.0;
  EXPECT_LT(chi_squared, 25) << "5 degrees of freedom: beyond 25 in 1 of 7,000 fair dice";
  EXPECT_EQ(rng.below(1), 0);
  for (int i = 0; i < 1000; ++i) {
    const int x = rng.integer(-2, 2);
    ASSERT_TRUE(x >= -2 && x <= 2);
  }
  EXPECT_EQ(rng.integer(4, 4), 4);
}

TEST(Stream, ChanceHasItsProbability) {
  Stream rng(3);
  int hits = 0;
  constexpr int count = 40'000;
  for (int i = 0; i < count; ++i) hits += rng.chance(0.25);
  EXPECT_NEAR(hits, 10'000, 5 * std::sqrt(count * 0.25 * 0.75));
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(rng.chance(1));
    EXPECT_FALSE(rng.chance(0));
  }
}

TEST(Stream, ServesTheStandardLibrary) {
  static_assert(std::uniform_random_bit_generator<Stream>);
  std::vector<int> cards(52);
  for (int i = 0; i < 52; ++i) cards[static_cast<std::size_t>(i)] = i;
  std::shuffle(cards.begin(), cards.end(), Stream(4));
  EXPECT_FALSE(std::is_sorted(cards.begin(), cards.end()));
}

}  // namespace
}  // namespace maximin
