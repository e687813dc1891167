#include <maximin/deep/places.hpp>

#include <bit>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {

// Both zeros are one place.
std::uint64_t Places::key(float x, float y) {
  const auto bits = [](float v) { return std::uint64_t{std::bit_cast<std::uint32_t>(v + 0.0F)}; };
  return bits(x) << 32U | bits(y);
}

Places::Places(const Metric<double>::Points& points) {
  if (points.cols() != 2) {
    throw InputError(fmt::format("places: points of {} coordinates, expected 2", points.cols()));
  }
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Point p{points(row, 0), points(row, 1)};
    const auto s = static_cast<State>(row);
    const auto [other, fresh] = state_of_.emplace(key(static_cast<float>(p.x), static_cast<float>(p.y)), s);
    if (!fresh) {
      throw InputError(fmt::format(
          "places: states {} and {} stand at the same point, expected places that differ as floats", other->second, s));
    }
    points_.push_back(p);
  }
}

State Places::state_at(float x, float y) const {
  const auto found = state_of_.find(key(x, y));
  if (found == state_of_.end()) {
    throw InputError(fmt::format("places: no state stands at ({}, {}), expected the place of one", x, y));
  }
  return found->second;
}

State Places::state_at(Point place) const {
  const State s = state_at(static_cast<float>(place.x), static_cast<float>(place.y));
  if (point(s) == place) return s;
  throw InputError(fmt::format("places: no state stands at ({}, {}), expected exactly the place of one, e.g. ({}, {})",
                               place.x, place.y, point(s).x, point(s).y));
}

PlacesWorld::PlacesWorld(const TabularEnvironment<double>& environment, const Places& places)
    : environment_(&environment), places_(&places) {
  if (places.states() != environment.mdp().states()) {
    throw InputError(
        fmt::format("places: {}, expected one per state, {}", places.states(), environment.mdp().states()));
  }
}

Outcome<Point> PlacesWorld::step(Point at, Action action, Stream& rng) const {
  const Outcome<State> outcome = environment_->step(places_->state_at(at), action, rng);
  return {places_->point(outcome.next), outcome.reward, outcome.terminal};
}

}  // namespace maximin::deep
