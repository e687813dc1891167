#include <maximin/proofs_check/certificate/orbit_search.hpp>

#include <cstddef>
#include <utility>

namespace maximin {
namespace {

constexpr long most_orbit_unknowns = 1'000;

/// Differences that vanish in the limit alone decide such ties: no number of rounds would show it.
constexpr int most_failures = 16;

}  // namespace

std::optional<EnteredOrbit> OrbitSearch::after_round(Policy composed, const ScaledTable& q) {
  composed_.push_back(std::move(composed));
  const auto n = static_cast<long>(composed_.size());
  if (n < next_attempt_) return std::nullopt;
  const long k = period();
  if (k == 0 || mdp_.states() * k > most_orbit_unknowns) return std::nullopt;
  const auto [entry, is_new] = candidates_.try_emplace({composed_.end() - k, composed_.end()});
  Candidate& candidate = entry->second;
  if (is_new) candidate.orbit = find_orbit(mdp_, scaled_, balls_, entry->first);

  Rational off = distance(q, candidate.orbit.tables.front());
  if (off > candidate.orbit.radius) return std::nullopt;
  if (auto phases = settle(mdp_, balls_, candidate.orbit, q, options_.tie)) {
    return EnteredOrbit{std::move(candidate.orbit), std::move(*phases), std::move(off)};
  }
  next_attempt_ = n + 1 + n / 4;  // what is equal for ever may become so later
  hopeless_ = ++candidate.failures >= most_failures;
  return std::nullopt;
}

}  // namespace maximin
