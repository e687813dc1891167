#include <maximin/apps/maximin/grid_map.hpp>

#include <algorithm>
#include <cmath>

namespace maximin::apps {

namespace {

constexpr int largest_side = 40;

/// The numbers as multiples of a common step, counted from the least; empty if they are not, or too many.
std::vector<int> grid_indices(std::vector<double> values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  double step = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double gap = sorted[i] - sorted[i - 1];
    if (gap > 0 && (step == 0 || gap < step)) step = gap;
  }
  std::vector<int> indices;
  for (const double x : values) {
    const double index = step > 0 ? (x - sorted.front()) / step : 0;
    if (!(index < largest_side) || std::abs(index - std::round(index)) > 1e-6) return {};
    indices.push_back(static_cast<int>(std::lround(index)));
  }
  return indices;
}

bool has(std::span<const State> set, State s) {
  return std::binary_search(set.begin(), set.end(), s);
}

}  // namespace

std::optional<GridMap> GridMap::of(const Model<double>& model) {
  const auto& points = model.geometry.points;
  if (points.rows() != model.mdp.states() || points.cols() < 1 || points.cols() > 2) return std::nullopt;
  const auto n = static_cast<std::size_t>(points.rows());
  const auto coordinate = [&](Eigen::Index axis) {
    std::vector<double> values(n);
    for (std::size_t s = 0; s < n; ++s) values[s] = points(static_cast<Eigen::Index>(s), axis);
    return values;
  };
  const std::vector<int> xs = grid_indices(coordinate(0));
  const std::vector<int> ys = points.cols() == 2 ? grid_indices(coordinate(1)) : std::vector<int>(n, 0);
  if (xs.empty() || ys.empty()) return std::nullopt;
  GridMap map(*std::max_element(xs.begin(), xs.end()) + 1, *std::max_element(ys.begin(), ys.end()) + 1);
  if (map.cells_.size() > 4 * n) return std::nullopt;
  for (std::size_t s = 0; s < n; ++s) {
    State& there = map.cell(xs[s], ys[s]);
    if (there != -1) return std::nullopt;
    there = static_cast<State>(s);
  }
  return map;
}

std::string GridMap::draw(const Scene& scene) const {
  std::string text;
  for (int y = rows_ - 1; y >= 0; --y) {
    std::string line = " ";
    for (int x = 0; x < columns_; ++x) {
      const State s = cell(x, y);
      const bool truth = s == scene.truth, shown = s == scene.shown;
      line += ' ';
      line += s == -1 ? ' ' : truth && shown ? '&' : truth ? '@' : shown ? 'o' : ' ';
      line += s == -1 ? ' ' : has(scene.belief, s) ? '#' : has(scene.ball, s) ? '+' : '.';
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string GridMap::legend() {
  return "Map: @ the true state, o what is shown, & both; # in the belief, + in the ball of what is shown but not in "
         "the\n"
         "belief, . any other state.\n";
}

}  // namespace maximin::apps
