#include <maximin/models/random_lipschitz_kernel.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// Rows before l_p is imposed.
struct Draft {
  std::vector<QTable<double>> rows;          ///< P0, one matrix per action
  std::vector<std::vector<State>> favoured;  ///< [a][s]: the successor that row (s,a) is concentrated on
};

/// Adds a random distribution over `count` distinct states (all of them if count is |S|) with one favoured state, which
/// is returned, to an all-zero row.
template <class Row>
State draw_row(Row row, State count, double sharpness, Stream& rng) {
  const auto n = static_cast<State>(row.size());
  State favoured = -1;
  for (State drawn = 0; drawn < count; ++drawn) {
    State target = drawn;
    if (count < n) {
      do target = rng.below(n);
      while (row[target] > 0);
    }
    const double u = rng.uniform();
    row[target] = 0x1p-20 + u * u;
    if (favoured < 0) favoured = target;
  }
  if (count == n) favoured = rng.below(n);
  row *= (1 - sharpness) / row.sum();
  row[favoured] += sharpness;
  return favoured;
}

/// Draws P0. For one action the nearest pair of states favours different successors, so that concentrating the rows
/// attains the largest constant there is, 1/d_min.
Draft draw_draft(const PairwiseDistances& distances, const LipschitzMdpOptions& options, State own, Stream& rng) {
  const State n = distances.states();
  const Action sharp_action = rng.below(options.actions);
  Draft draft;
  for (Action a = 0; a < options.actions; ++a) {
    QTable<double> rows = QTable<double>::Zero(n, n);
    std::vector<State> favoured(static_cast<std::size_t>(n));
    for (State s = 0; s < n; ++s) {
      const auto i = static_cast<std::size_t>(s);
      favoured[i] = draw_row(rows.row(s), own, options.sharpness, rng);
      if (a != sharp_action || n == 1 || s != distances.nearest.second) continue;
      while (favoured[i] == favoured[static_cast<std::size_t>(distances.nearest.first)]) {
        rows.row(s).setZero();
        favoured[i] = draw_row(rows.row(s), own, options.sharpness, rng);
      }
    }
    draft.rows.push_back(std::move(rows));
    draft.favoured.push_back(std::move(favoured));
  }
  return draft;
}

double lipschitz_constant_of(const std::vector<QTable<double>>& kernel, const PairwiseDistances& distances) {
  double constant = 0;
  for (const auto& rows : kernel) {
    for (State s = 0; s < distances.states(); ++s) {
      for (State t = s + 1; t < distances.states(); ++t) {
        const double difference = (rows.row(s) - rows.row(t)).cwiseAbs().maxCoeff();
        constant = std::max(constant, difference / distances(s, t));
      }
    }
  }
  return constant;
}

/// The largest m in [0,1] for which (1-m) P0 + m E stays l_p-Lipschitz, E being the rows concentrated on their favoured
/// successors. Every difference is linear in m, so the first one to reach l_p d(s,t) decides.
double largest_concentration(const Draft& draft, const PairwiseDistances& distances, double l_p) {
  double m = 1;
  for (std::size_t a = 0; a < draft.rows.size(); ++a) {
    for (State s = 0; s < distances.states(); ++s) {
      for (State t = s + 1; t < distances.states(); ++t) {
        const State to_s = draft.favoured[a][static_cast<std::size_t>(s)];
        const State to_t = draft.favoured[a][static_cast<std::size_t>(t)];
        for (State j = 0; j < distances.states(); ++j) {
          const double before = draft.rows[a](s, j) - draft.rows[a](t, j);
          const double slope = static_cast<double>(j == to_s) - static_cast<double>(j == to_t) - before;
          const double room = l_p * distances(s, t) - (slope > 0 ? before : -before);
          if (slope != 0) m = std::min(m, room / std::abs(slope));
        }
      }
    }
  }
  return m;
}

void concentrate(Draft& draft, double m) {
  for (std::size_t a = 0; a < draft.rows.size(); ++a) {
    draft.rows[a] *= 1 - m;
    for (std::size_t s = 0; s < draft.favoured[a].size(); ++s) {
      draft.rows[a](static_cast<Eigen::Index>(s), draft.favoured[a][s]) += m;
    }
  }
}

/// P = (1-t) nu_a + t P0, with a random common row nu_a of `common` successors for each action, or one for all.
void contract(Draft& draft, double t, State common, const LipschitzMdpOptions& options, Stream& rng) {
  Eigen::RowVectorXd nu;
  for (auto& rows : draft.rows) {
    if (nu.size() == 0 || !options.same_common_row) {
      nu = Eigen::RowVectorXd::Zero(rows.cols());
      draw_row(nu.row(0), common, options.sharpness, rng);
    }
    rows *= t;
    rows.rowwise() += (1 - t) * nu;
  }
}

}  // namespace

std::vector<QTable<double>> random_lipschitz_kernel(const PairwiseDistances& distances,
                                                    const LipschitzMdpOptions& options, Stream& rng) {
  const State n = distances.states();
  const double reach = n == 1 ? 0 : 1 / distances.least;
  if (options.l_p > reach * (1 + 1e-12)) {
    throw InputError(
        fmt::format("l_p: {} requested, expected at most {}, the largest that any kernel reaches on these "
                    "points ({})",
                    options.l_p, reach,
                    n == 1 ? std::string("there is only one state")
                           : fmt::format("states {} and {} lie {} apart", distances.nearest.first,
                                         distances.nearest.second, distances.least)));
  }
  const bool dense = options.successors == 0 || options.successors >= n;
  const State common = dense ? n : options.successors / 2;
  const State own = dense ? n : options.successors - common;
  Draft draft = draw_draft(distances, options, own, rng);
  const double l_p = std::min(options.l_p, reach);
  const double drafted = lipschitz_constant_of(draft.rows, distances);
  if (drafted > l_p || drafted == 0) {
    contract(draft, l_p > 0 ? l_p / drafted : 0, common, options, rng);
  } else {
    concentrate(draft, largest_concentration(draft, distances, l_p));
  }
  return std::move(draft.rows);
}

}  // namespace maximin
