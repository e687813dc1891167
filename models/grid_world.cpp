#include <maximin/models/grid_world.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

struct MapCell {
  int x, y;
  char kind;
};

constexpr std::array<std::pair<int, int>, 4> moves{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

/// The cells of the map and which state each of them is.
struct Map {
  std::vector<MapCell> cells;  ///< that are no wall, in order of the states
  int width = 0, height = 0;
  std::vector<State> state_at;  ///< [y * width + x], -1 for a wall

  State after(State s, Action a) const {
    const MapCell& from = cells[static_cast<std::size_t>(s)];
    const auto [dx, dy] = moves[static_cast<std::size_t>(a)];
    const int x = from.x + dx, y = from.y + dy;
    if (x < 0 || x >= width || y < 0 || y >= height) return s;
    const State to =
        state_at[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    return to < 0 ? s : to;
  }
};

Map parse(const std::vector<std::string>& rows) {
  Map map;
  map.height = static_cast<int>(rows.size());
  map.width = rows.empty() ? 0 : static_cast<int>(rows[0].size());
  if (map.width == 0) throw InputError("map: empty, expected at least one cell");
  if (rows.size() > 1000 || rows[0].size() > 1000) throw InputError("map: too large, expected at most 1000 x 1000");
  map.state_at.assign(static_cast<std::size_t>(map.width) * rows.size(), -1);
  bool plain = false;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].size() != rows[0].size()) {
      throw InputError(
          fmt::format("map[{}]: {} cells, expected {} as in the first row", row, rows[row].size(), rows[0].size()));
    }
    const int y = map.height - 1 - static_cast<int>(row);
    for (int x = 0; x < map.width; ++x) {
      const char kind = rows[row][static_cast<std::size_t>(x)];
      if (std::string(".#SGT").find(kind) == std::string::npos) {
        throw InputError(fmt::format("map[{}][{}]: '{}', expected one of . # S G T", row, x, kind));
      }
      if (kind == '#') continue;
      plain = plain || kind == '.' || kind == 'S';
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      map.state_at[at] = static_cast<State>(map.cells.size());
      map.cells.push_back({x, y, kind});
    }
  }
  if (!plain) throw InputError("map: no plain cell, expected at least one of . S");
  return map;
}

void check(const GridWorldOptions& o) {
  if (!(o.slip >= 0 && o.slip <= 1)) throw InputError(fmt::format("slip: {}, expected 0 to 1", o.slip));
  if (!(o.eps >= 0 && std::isfinite(o.eps))) {
    throw InputError(fmt::format("eps: {}, expected a finite number >= 0", o.eps));
  }
}

double entry_reward(const MapCell& cell, const GridWorldOptions& o) {
  return cell.kind == 'G' ? o.goal : cell.kind == 'T' ? o.trap : o.step;
}

FiniteMdp<double> mdp_of(const Map& map, const GridWorldOptions& o) {
  const auto n = static_cast<State>(map.cells.size());
  FiniteMdpBuilder<double> builder(n, 4, o.discount);
  for (State s = 0; s < n; ++s) {
    const char kind = map.cells[static_cast<std::size_t>(s)].kind;
    for (Action a = 0; a < 4; ++a) {
      if (kind == 'G' || kind == 'T') {
        builder.transition(s, a, s, 1);
        continue;
      }
      std::map<State, double> row;
      row[map.after(s, a)] += 1 - o.slip;
      row[map.after(s, (a + 1) % 4)] += o.slip / 2;
      row[map.after(s, (a + 3) % 4)] += o.slip / 2;
      double reward = 0;
      for (const auto& [target, p] : row) {
        builder.transition(s, a, target, p);
        reward += p * entry_reward(map.cells[static_cast<std::size_t>(target)], o);
      }
      builder.reward(s, a, reward);
    }
  }
  return std::move(builder).build();
}

/// Uniform over S, or over all plain cells.
std::vector<double> start_of(const Map& map) {
  const auto uniform_over = [&](const char* kinds) {
    std::vector<double> start;
    double count = 0;
    for (const MapCell& cell : map.cells) {
      start.push_back(std::string(kinds).find(cell.kind) != std::string::npos ? 1 : 0);
      count += start.back();
    }
    for (double& p : start) p = count > 0 ? p / count : 0;
    return std::pair(start, count > 0);
  };
  const auto [start, found] = uniform_over("S");
  return found ? start : uniform_over(".").first;
}

}  // namespace

Model<double> grid_world(const std::vector<std::string>& rows, const GridWorldOptions& options) {
  check(options);
  const Map map = parse(rows);
  Model<double> model{.mdp = mdp_of(map, options)};
  model.name = fmt::format("grid world, {} x {}", map.width, map.height);
  model.action_names = {"north", "east", "south", "west"};
  model.start = start_of(map);
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points.resize(static_cast<Eigen::Index>(map.cells.size()), 2);
  for (std::size_t s = 0; s < map.cells.size(); ++s) {
    const MapCell& cell = map.cells[s];
    model.geometry.points.row(static_cast<Eigen::Index>(s)) << cell.x, cell.y;
    model.state_names.push_back(cell.kind == 'G'   ? fmt::format("goal-{}-{}", cell.x, cell.y)
                                : cell.kind == 'T' ? fmt::format("trap-{}-{}", cell.x, cell.y)
                                                   : fmt::format("cell-{}-{}", cell.x, cell.y));
  }
  model.geometry.norm = options.norm;
  model.geometry.eps = options.eps;
  return model;
}

Model<double> grid_world(int width, int height, const GridWorldOptions& options) {
  if (width < 1 || width > 1000 || height < 1 || height > 1000 || width * height < 2) {
    throw InputError(fmt::format("grid: {} x {}, expected sides of 1 to 1000 and at least two cells", width, height));
  }
  std::vector<std::string> rows(static_cast<std::size_t>(height), std::string(static_cast<std::size_t>(width), '.'));
  rows.back().front() = 'S';
  rows.front().back() = 'G';
  if (width >= 2 && height >= 2 && width * height > 4) rows[1].back() = 'T';
  return grid_world(rows, options);
}

}  // namespace maximin
