#include <maximin/proofs_check/certificate/belief_positions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/position_graph.hpp>

namespace maximin {
namespace {

using Position = std::pair<State, Belief>;
using Graph = internal::PositionGraph<Rational>;

/// What may follow a move: for each successor state its probability and the positions the attacker can make of it.
struct Branch {
  Rational probability;
  double rounded;  ///< the probability in floating point
  std::vector<std::size_t> answers;
};
struct Move {
  Rational reward;
  std::vector<Branch> branches;
};

/// The game with its arcs spelt out, in rationals and in floating point. Behind the last position stands one for all
/// that are not listed: `unlisted`, whose value is known to be no less.
struct Game {
  Rational discount, unlisted;
  std::vector<Position> positions;  ///< in the order of a certificate: ascending
  std::vector<std::vector<Move>> moves;

  std::size_t size() const { return moves.size(); }
};

/// The positions of the graph that were looked into, in ascending order.
std::vector<std::size_t> ascending(const Graph& graph) {
  const auto& positions = graph.positions();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].moves.empty()) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const auto &x = positions[i], &y = positions[j];
    return x.truth != y.truth ? x.truth < y.truth : graph.belief(x) < graph.belief(y);
  });
  return order;
}

Game game_on(const Graph& graph, const FiniteMdp<Rational>& mdp) {
  const std::vector<std::size_t> order = ascending(graph);
  std::vector<std::size_t> rank(graph.positions().size(), order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  Game game{mdp.discount(), mdp.rewards().minCoeff() / Rational(1 - mdp.discount()), {}, {}};
  for (const std::size_t i : order) {
    const Graph::Position& position = graph.positions()[i];
    game.positions.emplace_back(position.truth, graph.belief(position));
    auto& moves = game.moves.emplace_back();
    for (const Graph::Move& from : position.moves) {
      Move& move = moves.emplace_back(Move{from.reward, {}});
      for (const auto& [probability, answers] : from.branches) {
        Branch& branch = move.branches.emplace_back(Branch{probability, static_cast<double>(probability), {}});
        for (const int k : answers) branch.answers.push_back(rank[static_cast<std::size_t>(k)]);
        std::sort(branch.answers.begin(), branch.answers.end());
      }
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

/// The least over the moves of R + gamma sum P min over the answers, at one position.
Rational backup_at(const Game& game, std::size_t i, const std::vector<Rational>& w) {
  std::optional<Rational> least;
  for (const Move& move : game.moves[i]) {
    Rational sum(0);
    for (const Branch& branch : move.branches) sum += branch.probability * worst(branch, w);
    Rational value = move.reward + game.discount * sum;
    if (!least || value < *least) least = std::move(value);
  }
  return *least;
}

/// Values by value iteration in floating point: near, and nothing is claimed of them.
std::vector<double> near_values(const Game& game) {
  const auto discount = static_cast<double>(game.discount);
  std::vector<double> rewards, w(game.size() + 1, static_cast<double>(game.unlisted)), next(w);
  for (const auto& moves : game.moves) {
    for (const Move& move : moves) rewards.push_back(static_cast<double>(move.reward));
  }
  for (int sweep = 0; sweep < 100'000; ++sweep) {
    double change = 0, size = 0;
    const double* reward = rewards.data();
    for (std::size_t i = 0; i < game.size(); ++i) {
      next[i] = std::numeric_limits<double>::infinity();
      for (const Move& move : game.moves[i]) {
        double sum = 0;
        for (const Branch& branch : move.branches) sum += branch.rounded * worst(branch, w);
        next[i] = std::min(next[i], *reward++ + discount * sum);
      }
      change = std::max(change, std::abs(next[i] - w[i]));
      size = std::max(size, std::abs(next[i]));
    }
    w.swap(next);
    if (!(change > 1e-14 * size)) break;
  }
  w.pop_back();
  return w;
}

/// Exact values, of a game whose positions are all listed and have one move: the attack that floating point finds,
/// solved exactly, and improved exactly while it can be.
std::vector<Rational> exact_values(const Game& game, const std::vector<double>& near) {
  std::vector<Rational> w(near.begin(), near.end());
  for (bool changed = true; changed;) {
    ExactSystem system{game.discount, {}, {}};
    for (const auto& moves : game.moves) {
      system.rewards.push_back(moves.front().reward);
      std::map<State, Rational> row;
      for (const Branch& branch : moves.front().branches) {
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
  double size = 0;
  for (const double w : near) size = std::max(size, std::abs(w));
  if (!(size > 0)) size = 1;
  const Rational grid(std::exp2(std::floor(std::log2(size)) - 40));
  for (Rational down(0); down <= Rational(size); down = down == 0 ? grid : Rational(16 * down)) {
    std::vector<Rational> w;
    for (const double x : near) {
      const Rational steps = (Rational(x) - down) / grid;
      Integer whole = numerator(steps) / denominator(steps);
      if (whole > steps) --whole;
      w.push_back(grid * whole);
    }
    w.push_back(game.unlisted);
    bool below = true;
    for (std::size_t i = 0; i < game.size() && below; ++i) below = w[i] <= backup_at(game, i, w);
    w.pop_back();
    if (below) return w;
  }
  return std::nullopt;
}

}  // namespace

std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const Graph::BeliefChoices& choices,
                                                       const CertifyOptions& options) {
  const Graph graph(mdp, geometry.balls(), choices, options.max_positions);
  Game game = game_on(graph, mdp);
  CertifiedBeliefGame result;
  bool single = graph.complete();
  for (State s = 0; s < mdp.states(); ++s) {
    if (!graph.looked_into_starts(s)) return std::nullopt;
  }
  for (const auto& moves : game.moves) single = single && moves.size() == 1;
  result.exact = single && static_cast<long>(game.size()) <= options.max_exact_positions;
  result.positions = std::move(game.positions);
  for (const auto& [truth, belief] : result.positions) {
    for (const State m : belief) result.reach = std::max(result.reach, geometry.lower(truth, m));
  }
  std::vector<double> near = near_values(game);
  const bool fits = std::all_of(near.begin(), near.end(), [](double w) { return std::isfinite(w); });
  if (!fits) std::fill(near.begin(), near.end(), 0.0);  // any start will do for exact values
  const auto values = result.exact ? exact_values(game, near) : lower_bounds(game, near);
  if (!values) return std::nullopt;
  result.values = Eigen::Map<const Values<Rational>>(values->data(), static_cast<Eigen::Index>(values->size()));
  return result;
}

std::optional<CertifiedBeliefGame> certify_belief_game(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                                                       const QTable<Rational>& q, const CertifyOptions& options) {
  const BeliefPolicy policy = maximin_belief_policy(q, options.tie);
  return certify_belief_game(
      mdp, geometry, [&](std::span<const State> belief) { return std::vector{policy(belief)}; }, options);
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
