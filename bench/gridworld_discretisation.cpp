#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <vector>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/rollout.hpp>

/// What the lattice of models/gridworld_lattice.hpp makes of the continuous Gridworld: how far its diagonal moves lead
/// astray, what it thinks its optimal policy is worth, and what that policy gets in the continuous world, which sees
/// the lattice point of the square that it is in.
namespace maximin {
namespace {

constexpr long episodes = 20'000;

/// By lattice square, the action of a policy.
class LatticeAgent {
 public:
  using ObservationType = Point;
  using ActionType = Action;

  LatticeAgent(const Model<double>& model, double spacing, Policy policy)
      : spacing_(spacing), policy_(std::move(policy)) {
    for (State s = 0; s < model.mdp.states(); ++s) {
      states_[square({model.geometry.points(s, 0), model.geometry.points(s, 1)})] = s;
    }
  }
  State nearest(Point p) const { return states_.at(square(p)); }
  Action begin(Point p, Stream&) const { return policy_[static_cast<std::size_t>(nearest(p))]; }
  Action act(Point p, Stream& rng) const { return begin(p, rng); }

 private:
  long square(Point p) const {
    return 1'000'000 * std::lround(std::floor(p.x / spacing_)) + std::lround(std::floor(p.y / spacing_));
  }
  double spacing_;
  std::unordered_map<long, State> states_;
  Policy policy_;
};

struct ShowTruth {
  Point perturb(Point truth, const LatticeAgent&, Stream&) const { return truth; }
};

/// How far the diagonal moves that go through end from where they should: root mean square, and how far their mean is
/// off at most; and how many of them the lattice takes for blocked, or pays otherwise than the world does.
struct MoveError {
  double rms = 0, bias = 0, misjudged = 0;
};

MoveError move_error(const Model<double>& model) {
  const ContinuousGridworld world;
  MoveError error;
  double moves = 0, free_moves = 0;
  for (State s = 0; s < model.mdp.states(); ++s) {
    if (model.start[static_cast<std::size_t>(s)] == 0) continue;
    const Point from{gridworld::round_down(model.geometry.points(s, 0)),
                     gridworld::round_down(model.geometry.points(s, 1))};
    for (const Action a : {1, 3, 5, 7}) {
      const auto o = world.step(from, a);
      const auto row = model.mdp.successors(s, a);
      const bool stays = row.size() == 1 && row[0].target == s;
      const bool wrong = stays != (o.next == from) || model.mdp.reward(s, a) != o.reward;
      ++moves;
      error.misjudged += wrong;
      if (wrong || stays) continue;
      double x = 0, y = 0, squares = 0;
      for (const auto& next : row) {
        const double dx = model.geometry.points(next.target, 0) - o.next.x;
        const double dy = model.geometry.points(next.target, 1) - o.next.y;
        x += next.probability * dx;
        y += next.probability * dy;
        squares += next.probability * (dx * dx + dy * dy);
      }
      ++free_moves;
      error.rms += squares;
      error.bias = std::max(error.bias, std::hypot(x, y));
    }
  }
  error.rms = std::sqrt(error.rms / free_moves);
  error.misjudged /= moves;
  return error;
}

/// The expected total reward of 100 steps by the policy, on the lattice.
double total_reward(const Model<double>& model, const Policy& policy) {
  Values<double> v = Values<double>::Zero(model.mdp.states()), next = v;
  for (long t = 0; t < ContinuousGridworld::horizon; ++t) {
    for (State s = 0; s < model.mdp.states(); ++s) {
      const Action a = policy[static_cast<std::size_t>(s)];
      next[s] = model.mdp.reward(s, a) + model.mdp.expectation(s, a, v);
    }
    v.swap(next);
  }
  double mean = 0;
  for (State s = 0; s < model.mdp.states(); ++s) mean += model.start[static_cast<std::size_t>(s)] * v[s];
  return mean;
}

void report(double spacing, DiagonalMove diagonal) {
  const auto model = gridworld_lattice({.spacing = spacing, .diagonal = diagonal});
  const auto solution = policy_iteration(model.mdp);
  double discounted = 0;
  for (State s = 0; s < model.mdp.states(); ++s) {
    discounted += model.start[static_cast<std::size_t>(s)] * solution.v[s];
  }
  ContinuousGridworld world;
  LatticeAgent agent(model, spacing, solution.policy);
  ShowTruth attack;
  double played = 0, played_discounted = 0, squares = 0, arrived = 0;
  for (long k = 0; k < episodes; ++k) {
    Stream rng(1, static_cast<std::uint64_t>(k));
    const Episode e = rollout(world, agent, attack, 0.99, ContinuousGridworld::horizon, rng);
    played += e.total_reward;
    squares += e.total_reward * e.total_reward;
    played_discounted += e.discounted_return;
    arrived += e.total_reward > 0;
  }
  const double n = episodes, mean = played / n;
  const MoveError error = move_error(model);
  fmt::print(
      "{:>7.4f}  {:<12}  {:>6}  {:>6.4f}  {:>6.4f}  {:>7.2f} %  {:>8.2f}  {:>8.2f}  {:>8.2f} +- {:.2f}  {:>8.2f}  "
      "{:>8.2f} %\n",
      spacing, diagonal == DiagonalMove::nearest ? "nearest" : "interpolated", model.mdp.states(), error.rms,
      error.bias, 100 * error.misjudged, total_reward(model, solution.policy), discounted, mean,
      1.96 * std::sqrt((squares / n - mean * mean) / n), played_discounted / n, 100 * arrived / n);
  std::fflush(stdout);
}

}  // namespace
}  // namespace maximin

int main() {
  fmt::print(
      "A diagonal move: rms and largest bias of its end, and how often the lattice misjudges wall or reward.\n"
      "The optimal policy for discount 0.99: on the lattice, total of 100 steps and discounted; the same played in "
      "the continuous world ({} episodes, no attack), and how many reach the gold.\n\n"
      "spacing  diagonal      states     rms    bias  misjudged   lattice  discounted  played           "
      "discounted  arrive\n",
      maximin::episodes);
  for (const int steps : {1, 2, 3, 4, 5, 7, 10}) {
    for (const auto diagonal : {maximin::DiagonalMove::nearest, maximin::DiagonalMove::interpolated}) {
      maximin::report(0.5 / steps, diagonal);
    }
  }
}
