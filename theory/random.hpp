#pragma once

#include <array>
#include <cstdint>

namespace maximin {

/// Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", 2011): a keyed
/// bijection of a 128-bit counter that passes BigCrush.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// The one source of randomness: draw k of stream (seed, trial) is a function of the three numbers alone. Trial 17 is
/// therefore the same on any number of threads, in any order, and when replayed by itself; and, unlike the
/// distributions of the standard library, the same with every compiler.
///
///     Stream rng(seed, trial);
///     double u = rng.uniform();
///     int die = 1 + rng.below(6);
class Stream {
 public:
  using result_type = std::uint64_t;

  constexpr explicit Stream(std::uint64_t seed, std::uint64_t trial = 0) : seed_(seed), trial_(trial) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  /// 64 random bits.
  constexpr result_type operator()() {
    const std::array<std::uint32_t, 4> counter{
        static_cast<std::uint32_t>(draw_), static_cast<std::uint32_t>(draw_ >> 32), static_cast<std::uint32_t>(trial_),
        static_cast<std::uint32_t>(trial_ >> 32)};
    ++draw_;
    const auto r = philox4x32(counter, {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
    return (std::uint64_t{r[1]} << 32) | r[0];
  }

  /// Uniform on [0, 1), a multiple of 2^-53.
  constexpr double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }

  /// Uniform on [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform on {0, ..., n-1}, without bias. n >= 1.
  constexpr int below(int n) {
    const auto bound = static_cast<std::uint64_t>(n);
    const std::uint64_t limit = max() - max() % bound;
    std::uint64_t r = (*this)();
    while (r >= limit) r = (*this)();
    return static_cast<int>(r % bound);
  }

  /// Uniform on {low, ..., high}.
  constexpr int integer(int low, int high) { return low + below(high - low + 1); }

  /// True with probability p.
  constexpr bool chance(double p) { return uniform() < p; }

 private:
  std::uint64_t seed_;
  std::uint64_t trial_;
  std::uint64_t draw_ = 0;
};

}  // namespace maximin
