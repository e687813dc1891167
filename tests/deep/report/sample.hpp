#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <maximin/deep/report/results.hpp>
#include <maximin/deep/report/trace.hpp>
#include <maximin/deep/report/training_log.hpp>
#include <maximin/gridworld/box_belief.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/gridworld/observation_ball.hpp>
#include <maximin/theory/random.hpp>

/// Things to show: real episodes of a small planner, and tables with made-up numbers.
namespace maximin::deep::sample {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The best value of the places, on squares of side 1/4, by value iteration.
class Planner {
 public:
  Planner() {
    const ContinuousGridworld world;
    for (int sweep = 0; sweep < 120; ++sweep) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const Point p{(i + 0.5) * 10 / n, (j + 0.5) * 10 / n};
          if (gridworld::cell(p) != gridworld::Cell::free) continue;
          double best = -1e9;
          for (Action a = 0; a < 8; ++a) best = std::max(best, value(world, p, a));
          value_[index(p)] = best;
        }
      }
    }
  }

  double value(const ContinuousGridworld& world, Point p, Action a) const {
    const Outcome<Point> o = world.step(p, a);
    return o.reward + (o.terminal ? 0 : 0.99 * value_[index(o.next)]);
  }

  /// Best on average over the points.
  Action best(const std::vector<Point>& points) const {
    const ContinuousGridworld world;
    std::array<double, 8> sum{};
    for (const Point& p : points) {
      if (gridworld::cell(p) != gridworld::Cell::free) continue;
      for (Action a = 0; a < 8; ++a) sum[static_cast<std::size_t>(a)] += value(world, p, a);
    }
    return static_cast<Action>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  }

 private:
  static constexpr int n = 40;
  static std::size_t index(Point p) {
    const auto at = [](double v) { return std::clamp(static_cast<int>(v * n / 10), 0, n - 1); };
    return static_cast<std::size_t>(at(p.y) * n + at(p.x));
  }
  std::array<double, n * n> value_{};
};

enum class Kind { box_belief, particles, no_belief };

/// A real episode. The attacker shows what makes the planner's move on it worst, of `tries` draws; 0 tries: the truth.
inline EpisodeTrace episode(Kind kind, double eps, int tries, std::uint64_t number) {
  static const Planner planner;
  const ContinuousGridworld world;
  const ObservationBall ball(eps);
  BoxBelief belief(ball);
  EpisodeTrace trace;
  trace.agent = kind == Kind::no_belief   ? "DQN"
                : kind == Kind::particles ? "BP-DQN, particles"
                                          : "BP-DQN, exact belief";
  trace.attack = tries == 0 ? "no attack" : tries < 4 ? "weak attack" : "strong attack";
  trace.eps = tries == 0 ? 0 : eps;
  trace.evaluation_seed = 5;
  trace.episode = static_cast<long>(number);
  Stream rng(5, number);
  Point at = world.reset(rng);
  Action last = 0;
  for (long time = 0; time < ContinuousGridworld::horizon; ++time) {
    Point shown = at;
    double worst = 1e9;
    for (int k = 0; k < tries; ++k) {
      const Point candidate = ball.draw(at, rng);
      const double harm = planner.value(world, at, planner.best({candidate}));
      if (harm < worst) worst = harm, shown = candidate;
    }
    const BoxUnion& held = time == 0 ? belief.reset(shown) : belief.update(last, shown);
    const std::vector<Point> particles = held.spread(24);
    TraceBelief drawn;
    if (kind == Kind::box_belief) drawn.boxes = held.boxes();
    if (kind == Kind::particles) {
      drawn.points = particles;
      for (std::size_t k = 0; k < particles.size(); ++k) drawn.weights.push_back(rng.uniform() / 12);
    }
    last = kind == Kind::no_belief ? planner.best({shown}) : planner.best(particles);
    const Outcome<Point> o = world.step(at, last);
    trace.add({time, at, shown, last, o.reward, o.next, o.terminal}, drawn);
    at = o.next;
    if (o.terminal) break;
  }
  return trace;
}

/// Returns around a mean, as the Gridworld's are: mostly gold, now and then wandering or the bomb.
inline SeedRun run(std::uint64_t seed, double share_of_gold, long episodes = 100) {
  SeedRun r{seed, 77, {}, 12.5};
  Stream rng(seed, 9);
  const double share = std::clamp(share_of_gold + rng.uniform(-0.06, 0.06), 0.0, 1.0);
  for (long k = 0; k < episodes; ++k) {
    r.returns.push_back(rng.chance(share) ? 200.0 - rng.below(25) : rng.chance(0.7) ? -100.0 : -50.0 - rng.below(40));
  }
  return r;
}

/// A table of three blocks: complete, half done, and planned.
inline ResultTable table() {
  ResultTable t;
  t.title = "Gridworld: defences and attacks";
  t.version = "0.1.0";
  t.command = "maximin_deep table --env gridworld --seeds 3 --episodes 100 -o table.json";
  t.configuration = {{"env", "gridworld"}, {"seeds", {1, 2, 3}}, {"episodes", 100}, {"frames", 1000000}};
  const std::vector<std::pair<std::string, double>> agents{
      {"DQN", 0.85}, {"SA-DQN", 0.88}, {"WocaR-DQN", 0.9}, {"BP-DQN", 0.95}};
  const std::vector<ResultBlock::Column> columns{{"no attack", 0}, {"PGD", 0.1}, {"PGD", 0.5}, {"MinBest", 0.5}};
  ResultBlock paper{"The paper's attacks", "They attack the raw Q network and know nothing of the belief.", {}};
  ResultBlock adaptive{"Adaptive attacks", "They attack the whole defence.", {}};
  double harder = 0;
  for (const auto& column : columns) {
    for (const auto& [agent, share] : agents) {
      ResultCell c{agent, column.attack, column.eps, {}, {}, {}, "", {}};
      const double left = agent == "BP-DQN" ? share - 0.2 * harder : share - harder;
      for (const std::uint64_t seed : {1u, 2u, 3u}) c.runs.push_back(run(seed * 100 + c.agent.size(), left));
      if (agent == "DQN") c.paper = PaperFigure{128, std::nullopt};
      if (agent == "BP-DQN") {
        c.paper = PaperFigure{163 - 40 * harder, 26};
        c.target = Target{Target::Sense::at_least, 150};
        c.measures = {{"truth in belief", 1.0}, {"empty intersections", 0.0}};
      }
      paper.cells.push_back(c);
      c.attack = "best response";
      c.target.reset();
      c.paper.reset();
      if (column.attack == "PGD") {
        for (SeedRun& r : c.runs) r = run(r.training_seed, left - 0.35);
        if (agent == "SA-DQN") c.runs.resize(1);
        if (agent == "WocaR-DQN") c.runs.clear();
        adaptive.cells.push_back(c);
      }
    }
    harder += 0.25;
  }
  t.blocks = {paper, adaptive, {"Noisy environment", "", {{"BP-DQN", "uniform noise", 0.5, {}, {}, {}, "", {}}}}};
  t.wall_seconds = 8000;
  return t;
}

/// A made-up training.
inline TrainingCurve curve(const std::string& agent, std::uint64_t seed, double best) {
  TrainingCurve c{agent, seed, {{"frames", "return", "loss", "exploration", "seconds"}, {}}};
  Stream rng(seed, 3);
  for (int k = 1; k <= 100; ++k) {
    const double done = k / 100.0;
    const double level = -100 + (best + 100) * (1 - std::exp(-5 * done)) + rng.uniform(-20, 20);
    std::optional<double> loss;
    if (k > 3) loss = 40 * std::exp(-4 * done) * rng.uniform(0.7, 1.3) + 0.4;
    c.log.rows.push_back({k * 10000.0, level, loss, std::max(0.05, 1 - 4 * done), 3.5 * k});
  }
  return c;
}

}  // namespace maximin::deep::sample
