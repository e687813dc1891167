#include <maximin/deep/tensors.hpp>

namespace maximin::deep {

torch::Tensor to_tensor(std::span<const Point> points) {
  torch::Tensor rows = torch::empty({static_cast<long>(points.size()), 2});
  float* out = rows.data_ptr<float>();
  for (const Point& p : points) {
    *out++ = static_cast<float>(p.x);
    *out++ = static_cast<float>(p.y);
  }
  return rows;
}

std::vector<Point> to_points(const torch::Tensor& rows) {
  const torch::Tensor dense = rows.detach().to(torch::kCPU, torch::kFloat).contiguous();
  const float* in = dense.data_ptr<float>();
  std::vector<Point> points(static_cast<std::size_t>(dense.size(0)));
  for (Point& p : points) {
    p.x = *in++;
    p.y = *in++;
  }
  return points;
}

}  // namespace maximin::deep
