#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include <maximin/gridworld/hull_control.hpp>
#include <maximin/theory/rollout.hpp>

/// What HullControl is sure of in the continuous Gridworld, and what its agent gets: without attack, under observations
/// drawn from the ball, a constant offset, and the attacker who shows what leaves least sure.
namespace maximin {
namespace {

struct Attacker {
  enum class Kind { none, random, aside, least_sure } kind;
  ObservationBall ball;

  Point perturb(Point truth, const HullAgent& agent, Stream& rng) const {
    switch (kind) {
      case Kind::none:
        return truth;
      case Kind::random:
        return ball.draw(truth, rng);
      case Kind::aside:
        return ball.project(truth, {truth.x + 9, truth.y - 9});
      case Kind::least_sure:
        break;
    }
    Point worst = truth;
    double least = agent.control().choice(agent.would_believe(truth)).value;
    for (int k = 0; k < 64; ++k) {
      const Point corner{truth.x + rng.integer(-1, 1) * 9, truth.y + rng.integer(-1, 1) * 9};
      const Point shown = k % 2 == 0 ? ball.project(truth, corner) : ball.draw(truth, rng);
      const double value = agent.control().choice(agent.would_believe(shown)).value;
      if (value >= least) continue;
      least = value;
      worst = shown;
    }
    return worst;
  }
};

double mean_return(const HullControl& control, Attacker::Kind kind, double& least) {
  constexpr long episodes = 5'000;
  ContinuousGridworld world;
  HullAgent agent(control);
  Attacker attack{kind, control.ball()};
  double sum = 0;
  least = 1e9;
  for (long k = 0; k < episodes; ++k) {
    Stream rng(1, static_cast<std::uint64_t>(k));
    const double total = rollout(world, agent, attack, 1, ContinuousGridworld::horizon, rng).total_reward;
    sum += total;
    least = std::min(least, total);
  }
  return sum / episodes;
}

void report(double eps, int cells_per_move) {
  const auto begin = std::chrono::steady_clock::now();
  const HullControl control(ObservationBall(eps), cells_per_move);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  constexpr int starts = 20'000;
  double sure = 0, worst = 1e9;
  for (const Point p : open_area().spread(starts)) {
    const double value = control.sure_from(p);
    sure += value / starts;
    worst = std::min(worst, value);
  }
  fmt::print("eps {:<4}  {:>2} squares to a move  {:>8} hulls  {:>5.1f} s  sure {:>7.2f}, worst {:>4.0f}  played", eps,
             cells_per_move, control.hulls(), seconds.count(), sure, worst);
  for (const auto kind :
       {Attacker::Kind::none, Attacker::Kind::random, Attacker::Kind::aside, Attacker::Kind::least_sure}) {
    double least = 0;
    const double mean = mean_return(control, kind, least);
    fmt::print("  {:.1f} ({:.0f})", mean, least);
    std::fflush(stdout);
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace maximin

int main() {
  fmt::print(
      "total rewards of 100 steps: sure (mean and worst over starts); played without attack, random, constant "
      "offset, least sure: mean (least of 5000)\n");
  for (const int k : {2, 5, 10}) maximin::report(0.1, k);
  for (const int k : {1, 2, 3, 4, 6}) maximin::report(0.5, k);
}
