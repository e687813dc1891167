#include <maximin/deep/attacks/offset_attack.hpp>

namespace maximin::deep {

void ConstantOffsetAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&,
                                   std::span<Stream> streams, std::span<Point> shown) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    if (corner_[l] < 0) corner_[l] = streams[l].below(4);
    const Point s = truths[k];
    shown[k] = {corner_[l] % 2 == 0 ? ball_.low(s.x) : ball_.high(s.x),
                corner_[l] / 2 == 0 ? ball_.low(s.y) : ball_.high(s.y)};
  }
}

}  // namespace maximin::deep
