#include <maximin/deep/attacks/ball_places.hpp>

#include <vector>

#include <maximin/deep/tensors.hpp>

namespace maximin::deep {

Point grid_place(const ObservationBall& ball, Point truth, int n, int i, int j) {
  const auto along = [&](double v, int at) { return ball.low(v) + (ball.high(v) - ball.low(v)) * at / (n - 1); };
  return ball.project(truth, {along(truth.x, i), along(truth.y, j)});
}

void add_grid(const ObservationBall& ball, Point truth, int n, std::vector<Point>& places) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) places.push_back(grid_place(ball, truth, n, i, j));
  }
}

BallBounds::BallBounds(std::span<const Point> truths, const ObservationBall& ball, torch::Device device) {
  std::vector<Point> lows, highs;
  for (const Point& s : truths) {
    lows.push_back({ball.low(s.x), ball.low(s.y)});
    highs.push_back({ball.high(s.x), ball.high(s.y)});
  }
  low = to_tensor(lows).to(device);
  high = to_tensor(highs).to(device);
}

torch::Tensor BallBounds::clamp(const torch::Tensor& places) const {
  return torch::maximum(torch::minimum(places, high), low);
}

}  // namespace maximin::deep
