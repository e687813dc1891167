#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/attacks/director.hpp>
#include <maximin/deep/q_network.hpp>

namespace maximin::deep {

struct AdaptiveDirectorOptions {
  DirectorOptions director{.hidden = {128, 128}};
  int grid = 3;  ///< it chooses out of grid x grid places over the ball, corners included
  /// Before it has learned anything it chooses as by softmax of -prior times the judge's value of what each place would
  /// provoke, on a scale where the judge's best and worst action are 1 apart. 0: evenly.
  double prior = 6;
};

/// Learned against the whole defence, and ahead of the myopic best response, from which it starts: it sees the truth,
/// the time left, what the agent believes and did last, its own last offset, and what each observation that it may
/// choose would provoke. Set beliefs are kept wide by offsets that tell nothing new, and traps of a pessimistic agent
/// need several steps: both are found by trying.
class AdaptiveDirector final : public Director {
 public:
  /// The judge says what an action is worth when s is true, e.g. the agent's own network; empty: no prior.
  AdaptiveDirector(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                   const AdaptiveDirectorOptions& options = {});

  void resize(Lane lanes) override;
  void forget(Lane lane) override;
  Situations look(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent) const override;
  nlohmann::ordered_json about() const override;

 private:
  static constexpr int no_choice = -1;

  void realise(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> choices,
               std::span<Stream> streams, std::span<Point> shown) override;
  std::vector<Action> provoked(std::span<const Lane> lanes, std::span<const Point> truths,
                               const GridAgent& agent) const;
  torch::Tensor harm(std::span<const Point> truths, const std::vector<Action>& provoked) const;
  Point place(Point truth, int choice) const;
  float* write_mind(Lane lane, Point truth, const GridAgent& agent, float* out) const;

  std::shared_ptr<ActionValueModule> judge_;
  AdaptiveDirectorOptions options_;
  std::vector<int> last_;  ///< choice of each lane
};

}  // namespace maximin::deep
