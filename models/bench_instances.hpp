#pragma once

#include <cstdint>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

/// Instances that solvers are timed on, defined to the last bit so that any program in any language can make the same
/// ones. Their randomness is SplitMix64 and not Stream for that reason alone.
namespace maximin::bench {

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  /// Uniform on [0, 1), a multiple of 2^-53.
  double u01() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// next() mod n; the bias is part of the definition. n >= 1.
  State below(State n) { return static_cast<State>(next() % static_cast<std::uint64_t>(n)); }

 private:
  std::uint64_t state_;
};

/// For s, for a: |S| weights u01, divided by their sum (added left to right); then R(s,a) = u01. A weight of exactly 0
/// is not stored.
FiniteMdp<double> dense_instance(State states, Action actions, double discount, std::uint64_t seed);

/// For s, for a: `successors` distinct targets by rejection of below(|S|), then a weight u01 for each in the order they
/// were drawn; sorted by target and divided by their sum (added in that order); then R(s,a) = u01.
/// Throws InputError unless 1 <= successors <= states.
FiniteMdp<double> sparse_instance(State states, Action actions, State successors, double discount, std::uint64_t seed);

/// Cells s = y width + x, actions 0 to 3 = (y-1), (x+1), (y+1), (x-1); a move off the board stays. The intended move
/// has probability 0.8, each perpendicular one 0.1; equal targets are merged in the order intended, (a+1)%4, (a+3)%4.
/// R(s,a) = -u01, drawn in order for every (s,a); the last cell is the goal, which absorbs with R = 0.
/// Throws InputError unless both sides are at least 1.
FiniteMdp<double> grid_instance(State width, State height, double discount, std::uint64_t seed);

}  // namespace maximin::bench
