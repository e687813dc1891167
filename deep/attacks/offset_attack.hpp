#pragma once

#include <optional>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// A corner of the ball of observations: bit 0 is right, bit 1 is up.
enum class Corner { lower_left, lower_right, upper_left, upper_right };

/// What becomes of the corner from step to step.
enum class CornerChange {
  never,     ///< every observation has the same error: none tells a set belief what the one before did not
  opposite,  ///< the opposite corner at every step
  drawn,     ///< one of the four, drawn anew at every step
};

struct OffsetOptions {
  std::optional<Corner> corner;  ///< that of the first step; without it one is drawn per episode
  CornerChange change = CornerChange::never;
};

/// Shows a corner of the ball. It looks at nothing but the truth; yet an offset that stays deceives the agent all the
/// time, and what is shown tells a set belief nothing that it did not know. Takes one number of a lane's stream where
/// it draws.
class ConstantOffsetAttack final : public GridAttack {
 public:
  explicit ConstantOffsetAttack(const ObservationBall& ball, const OffsetOptions& options = {})
      : ball_(ball), options_(options) {}

  void resize(Lane lanes) override { corners_.assign(static_cast<std::size_t>(lanes), std::nullopt); }
  void forget(Lane lane) override { corners_[static_cast<std::size_t>(lane)].reset(); }
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  Corner next(std::optional<Corner> last, Stream& rng) const;

  ObservationBall ball_;
  OffsetOptions options_;
  std::vector<std::optional<Corner>> corners_;  ///< of the lane's last observation
};

}  // namespace maximin::deep
