#include <maximin/deep/attacks/simple_attacks.hpp>

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace maximin::deep {

void NoAttack::perturb(std::span<const Lane>, std::span<const Point> truths, const GridAgent&, std::span<Stream>,
                       std::span<Point> shown) {
  std::copy(truths.begin(), truths.end(), shown.begin());
}

void RandomAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&,
                           std::span<Stream> streams, std::span<Point> shown) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    shown[k] = ball_.draw(truths[k], streams[static_cast<std::size_t>(lanes[k])]);
  }
}

void WithinBallInStep::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                               std::span<Stream> streams, std::span<Point> shown) {
  attack().perturb(lanes, truths, agent, streams, shown);
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    if (ball_.contains(truths[k], shown[k])) continue;
    const char* what = ball_.between_grid(truths[k], shown[k])
                           ? "no multiple of the quantum 2^-40, expected what ObservationBall::project makes of it"
                           : "outside its ball";
    throw std::logic_error(fmt::format("attack: showed ({}, {}) when ({}, {}) was true, which is {}", shown[k].x,
                                       shown[k].y, truths[k].x, truths[k].y, what));
  }
}

}  // namespace maximin::deep
