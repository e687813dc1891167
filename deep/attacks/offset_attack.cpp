#include <maximin/deep/attacks/offset_attack.hpp>

namespace maximin::deep {

Corner ConstantOffsetAttack::next(std::optional<Corner> last, Stream& rng) const {
  if (!last && options_.corner) return *options_.corner;
  if (!last || options_.change == CornerChange::drawn) return static_cast<Corner>(rng.below(4));
  if (options_.change == CornerChange::opposite) return static_cast<Corner>(3 - static_cast<int>(*last));
  return *last;
}

void ConstantOffsetAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&,
                                   std::span<Stream> streams, std::span<Point> shown) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    const Corner corner = next(corners_[l], streams[l]);
    corners_[l] = corner;
    const bool right = (static_cast<int>(corner) & 1) != 0, up = (static_cast<int>(corner) & 2) != 0;
    const Point s = truths[k];
    shown[k] = {right ? ball_.high(s.x) : ball_.low(s.x), up ? ball_.high(s.y) : ball_.low(s.y)};
  }
}

}  // namespace maximin::deep
