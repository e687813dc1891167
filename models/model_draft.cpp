#include <maximin/models/model_draft.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace maximin {
namespace {

using Row = ModelDraft::Row;

/// The entries of `list` whose index is kept; an absent list stays absent.
template <class T>
std::vector<T> selected(const std::vector<T>& list, const std::vector<State>& kept) {
  std::vector<T> result;
  if (list.empty()) return result;
  for (const State s : kept) result.push_back(list[static_cast<std::size_t>(s)]);
  return result;
}

template <class T>
void erase_entry(std::vector<T>& list, Action a) {
  if (!list.empty()) list.erase(list.begin() + a);
}

/// The row with every target renamed, probabilities of equal targets added.
Row renamed(const Row& row, const std::vector<State>& new_name, State instead) {
  Row result;
  for (const auto& next : row) {
    const State name = new_name[static_cast<std::size_t>(next.target)];
    const State target = name < 0 ? instead : name;
    const auto same = std::find_if(result.begin(), result.end(), [&](const auto& n) { return n.target == target; });
    if (same != result.end()) {
      same->probability += next.probability;
    } else {
      result.push_back({target, next.probability});
    }
  }
  std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) { return x.target < y.target; });
  return result;
}

void keep_in_geometry(Geometry<double>& geometry, const std::vector<State>& kept, const std::vector<State>& new_name) {
  const auto n = static_cast<Eigen::Index>(kept.size());
  if (geometry.points.size() > 0) {
    Metric<double>::Points points(n, geometry.points.cols());
    for (Eigen::Index i = 0; i < n; ++i) points.row(i) = geometry.points.row(kept[static_cast<std::size_t>(i)]);
    geometry.points = std::move(points);
  }
  if (geometry.distances.size() > 0) {
    QTable<double> distances(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        distances(i, j) = geometry.distances(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
      }
    }
    geometry.distances = std::move(distances);
  }
  geometry.neighbourhoods = selected(geometry.neighbourhoods, kept);
  for (auto& ball : geometry.neighbourhoods) {
    std::vector<State> left;
    for (const State t : ball) {
      if (const State name = new_name[static_cast<std::size_t>(t)]; name >= 0) left.push_back(name);
    }
    ball = std::move(left);
  }
}

}  // namespace

ModelDraft::ModelDraft(const Model<double>& model)
    : whole(model), discount(model.mdp.discount()), rewards(model.mdp.rewards()) {
  for (State s = 0; s < model.mdp.states(); ++s) {
    auto& of_state = rows.emplace_back();
    for (Action a = 0; a < model.mdp.actions(); ++a) {
      const auto row = model.mdp.successors(s, a);
      of_state.emplace_back(row.begin(), row.end());
    }
  }
}

Model<double> ModelDraft::build() && {
  FiniteMdpBuilder<double> builder(states(), actions(), discount);
  for (State s = 0; s < states(); ++s) {
    for (Action a = 0; a < actions(); ++a) {
      builder.reward(s, a, rewards(s, a));
      for (const auto& next : rows[static_cast<std::size_t>(s)][static_cast<std::size_t>(a)]) {
        builder.transition(s, a, next.target, next.probability);
      }
    }
  }
  whole.mdp = std::move(builder).build();
  return std::move(whole);
}

void ModelDraft::keep_states(const std::vector<bool>& kept, std::optional<State> instead) {
  std::vector<State> left, new_name(kept.size(), -1);
  for (std::size_t s = 0; s < kept.size(); ++s) {
    if (!kept[s]) continue;
    new_name[s] = static_cast<State>(left.size());
    left.push_back(static_cast<State>(s));
  }
  const auto place_taker = [&](std::size_t i) {
    return instead ? new_name[static_cast<std::size_t>(*instead)] : static_cast<State>(i);
  };
  QTable<double> rewards_left(static_cast<Eigen::Index>(left.size()), rewards.cols());
  std::vector<std::vector<Row>> rows_left;
  for (std::size_t i = 0; i < left.size(); ++i) {
    rewards_left.row(static_cast<Eigen::Index>(i)) = rewards.row(left[i]);
    auto& of_state = rows_left.emplace_back();
    for (const Row& row : rows[static_cast<std::size_t>(left[i])]) {
      of_state.push_back(renamed(row, new_name, place_taker(i)));
    }
  }
  rewards = std::move(rewards_left);
  rows = std::move(rows_left);
  whole.state_names = selected(whole.state_names, left);
  whole.start = selected(whole.start, left);
  const double mass = std::accumulate(whole.start.begin(), whole.start.end(), 0.0);
  if (!(mass > 0)) whole.start.clear();
  for (double& p : whole.start) p /= mass;
  keep_in_geometry(whole.geometry, left, new_name);
}

void ModelDraft::drop_action(Action a) {
  QTable<double> left(rewards.rows(), rewards.cols() - 1);
  left.leftCols(a) = rewards.leftCols(a);
  left.rightCols(left.cols() - a) = rewards.rightCols(left.cols() - a);
  rewards = std::move(left);
  for (auto& of_state : rows) of_state.erase(of_state.begin() + a);
  erase_entry(whole.action_names, a);
}

void ModelDraft::drop_dimension(Eigen::Index i) {
  const auto& points = whole.geometry.points;
  Metric<double>::Points left(points.rows(), points.cols() - 1);
  left.leftCols(i) = points.leftCols(i);
  left.rightCols(left.cols() - i) = points.rightCols(left.cols() - i);
  whole.geometry.points = std::move(left);
}

Row rounded_row(const Row& row, int parts) {
  std::vector<int> share(row.size());
  std::vector<std::size_t> by_remainder(row.size());
  std::iota(by_remainder.begin(), by_remainder.end(), std::size_t{0});
  const auto scaled = [&](std::size_t i) { return row[i].probability * parts; };
  int left = parts;
  for (std::size_t i = 0; i < row.size(); ++i) {
    share[i] = static_cast<int>(std::floor(scaled(i)));
    left -= share[i];
  }
  std::stable_sort(by_remainder.begin(), by_remainder.end(), [&](std::size_t i, std::size_t j) {
    return scaled(i) - std::floor(scaled(i)) > scaled(j) - std::floor(scaled(j));
  });
  for (std::size_t k = 0; left > 0; k = (k + 1) % row.size(), --left) ++share[by_remainder[k]];
  Row result;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (share[i] > 0) result.push_back({row[i].target, static_cast<double>(share[i]) / parts});
  }
  return result;
}

Row deterministic_row(const Row& row) {
  const auto likeliest = std::max_element(row.begin(), row.end(),
                                          [](const auto& x, const auto& y) { return x.probability < y.probability; });
  return {{likeliest->target, 1.0}};
}

}  // namespace maximin
