#include <maximin/proofs_check/certificate/belief_positions.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/position_graph.hpp>

namespace maximin {
namespace {

using Position = std::pair<State, Belief>;
using Graph = internal::PositionGraph<Rational>;

/// What may follow a position: for each successor state its probability and the positions the attacker can make of it.
struct Branch {
  Rational probability;
  double rounded;  ///< the probability in floating point
  std::vector<std::size_t> answers;
};

/// The game with its arcs spelt out, in rationals and in floating point.
struct Game {
  Rational discount;
  std::vector<Position> positions;  ///< in the order of a certificate: ascending
  std::vector<Rational> rewards;
  std::vector<std::vector<Branch>> branches;

  std::size_t size() const { return rewards.size(); }
};

/// The graph's positions in ascending order.
std::vector<std::size_t> ascending(const Graph& graph) {
  const auto& positions = graph.positions();
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const auto &x = positions[i], &y = positions[j];
    return x.truth != y.truth ? x.truth < y.truth : graph.belief(x) < graph.belief(y);
  });
  return order;
}

Game game_on(const Graph& graph, const Rational& discount) {
  const std::vector<std::size_t> order = ascending(graph);
  std::vector<std::size_t> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  Game game{discount, {}, {}, {}};
  for (const std::size_t i : order) {
    const Graph::Position& position = graph.positions()[i];
    game.positions.emplace_back(position.truth, graph.belief(position));
    game.rewards.push_back(position.reward);
    auto& branches = game.branches.emplace_back();
    for (const auto& [probability, answers] : position.branches) {
      Branch& branch = branches.emplace_back(Branch{probability, static_cast<double>(probability), {}});
      for (const int k : answers) branch.answers.push_back(rank[static_cast<std::size_t>(k)]);
      std::sort(branch.answers.begin(), branch.answers.end());
    }
  }
  return game;
}

/// What the attacker leaves of w where a branch leads.
template <class Scalar>
const Scalar& worst(const Branch& branch, const std::vector<Scalar>& w) {
  const Scalar* least = &w[branch.answers.front()];
  for (const std::size_t k : branch.answers) {
    if (w[k] < *least) least = &w[k];
  }
  return *least;
}

/// R + gamma sum P min over the answers, at one position.
Rational backup_at(const Game& game, std::size_t i, const std::vector<Rational>& w) {
  Rational sum(0);
  for (const Branch& branch : game.branches[i]) sum += branch.probability * worst(branch, w);
  return game.rewards[i] + game.discount * sum;
}

/// Values by value iteration in floating point: near, and nothing is claimed of them.
std::vector<double> near_values(const Game& game) {
  const auto discount = static_cast<double>(game.discount);
  std::vector<double> rewards, w(game.size(), 0.0), next(game.size());
  for (const Rational& r : game.rewards) rewards.push_back(static_cast<double>(r));
  for (int sweep = 0; sweep < 100'000; ++sweep) {
    double change = 0, size = 0;
    for (std::size_t i = 0; i < game.size(); ++i) {
      double sum = 0;
      for (const Branch& branch : game.branches[i]) sum += branch.rounded * worst(branch, w);
      next[i] = rewards[i] + discount * sum;
      change = std::max(change, std::abs(next[i] - w[i]));
      size = std::max(size, std::abs(next[i]));
    }
    w.swap(next);
    if (!(change > 1e-14 * (1 + size))) break;
  }
  return w;
}

/// Exact values: the attack that floating point finds, solved exactly, and improved exactly while it can be.
std::vector<Rational> exact_values(const Game& game, const std::vector<double>& near) {
  std::vector<Rational> w(near.begin(), near.end());
  for (bool changed = true; changed;) {
    ExactSystem system{game.discount, game.rewards, {}};
    for (const auto& branches : game.branches) {
      std::map<State, Rational> row;
      for (const Branch& branch : branches) {
        const std::size_t worst = *std::min_element(branch.answers.begin(), branch.answers.end(),
                                                    [&](std::size_t x, std::size_t y) { return w[x] < w[y]; });
        row[static_cast<State>(worst)] += branch.probability;
      }
      auto& out = system.rows.emplace_back();
      for (const auto& [target, probability] : row) out.push_back({target, probability});
    }
    const Values<Rational> solved = solve_exactly(system);
    w.assign(solved.begin(), solved.end());
    changed = false;
    for (std::size_t i = 0; i < game.size() && !changed; ++i) changed = backup_at(game, i, w) != w[i];
  }
  return w;
}

/// Values with W <= TW, checked exactly: floating point, taken down by more and more until they are.
std::optional<std::vector<Rational>> lower_bounds(const Game& game, const std::vector<double>& near) {
  double size = 1;
  for (const double w : near) size = std::max(size, std::abs(w));
  const Rational grid(std::exp2(std::floor(std::log2(size)) - 40));
  for (Rational down(0); down <= Rational(size); down = down == 0 ? grid : Rational(16 * down)) {
    std::vector<Rational> w;
    for (const double x : near) {
      const Rational steps = (Rational(x) - down) / grid;
      Integer whole = numerator(steps) / denominator(steps);
      if (whole > steps) --whole;
      w.push_back(grid * whole);
    }
    bool below = true;
    for (std::size_t i = 0; i < w.size() && below; ++i) below = w[i] <= backup_at(game, i, w);
    if (below) return w;
  }
  return std::nullopt;
}

}  // namespace

std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const QTable<Rational>& q, const CertifyOptions& options) {
  const BeliefPolicy policy = maximin_belief_policy(q, options.tie);
  const Graph graph(mdp, geometry.balls, policy, options.max_positions);
  if (!graph.complete()) return std::nullopt;
  Game game = game_on(graph, mdp.discount());
  CertifiedBeliefGame result;
  result.positions = std::move(game.positions);
  for (const auto& [truth, belief] : result.positions) {
    for (const State m : belief) result.reach = std::max(result.reach, geometry.lower(truth, m));
  }
  std::vector<double> near = near_values(game);
  const bool fits = std::all_of(near.begin(), near.end(), [](double w) { return std::isfinite(w); });
  if (!fits) std::fill(near.begin(), near.end(), 0.0);  // any start will do for exact values
  result.exact = static_cast<long>(game.size()) <= options.max_exact_positions;
  const auto values = result.exact ? exact_values(game, near) : lower_bounds(game, near);
  if (!values) return std::nullopt;
  result.values = Eigen::Map<const Values<Rational>>(values->data(), static_cast<Eigen::Index>(values->size()));
  return result;
}

Values<Rational> start_values(const CertifiedBeliefGame& game, const Perturbation<Rational>& balls) {
  Values<Rational> v(balls.states());
  const auto value_at = [&](const Position& p) -> const Rational& {
    const auto found = std::lower_bound(game.positions.begin(), game.positions.end(), p);
    return game.values[found - game.positions.begin()];
  };
  for (State s = 0; s < balls.states(); ++s) {
    std::optional<Rational> least;
    for (const State t : balls.ball(s)) {
      const Rational& w = value_at({s, Belief(balls.ball(t).begin(), balls.ball(t).end())});
      if (!least || w < *least) least = w;
    }
    v[s] = *least;
  }
  return v;
}

}  // namespace maximin
