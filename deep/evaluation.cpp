#include <maximin/deep/evaluation.hpp>

#include <chrono>
#include <functional>

#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/theory/rollout_in_step.hpp>

namespace maximin::deep {
namespace {

EpisodesInStep paper_episodes(long episodes, std::uint64_t seed) {
  EpisodesInStep options;
  options.horizon = ContinuousGridworld::horizon;
  options.episodes = episodes;
  options.seed = seed;
  return options;
}

/// The agent with a witness looking at its beliefs right after it took in what was shown.
class Watched {
 public:
  using ObservationType = Point;
  using ActionType = Action;

  explicit Watched(GridAgent& agent) : agent_(&agent) {}
  void resize(Lane lanes) { agent_->resize(lanes); }
  void forget(Lane lane) { agent_->forget(lane); }
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) {
    agent_->act(lanes, shown, streams, actions);
    if (looked) looked(lanes);
  }
  const GridAgent& agent() const { return *agent_; }

  std::function<void(std::span<const Lane>)> looked;

 private:
  GridAgent* agent_;
};

/// The attack on what is watched: keeps to the ball, and remembers the truths.
class WatchedAttack {
 public:
  WatchedAttack(GridAttack& attack, const ObservationBall& ball) : bounded_(attack, ball) {}
  void resize(Lane lanes) { bounded_.resize(lanes); }
  void forget(Lane lane) { bounded_.forget(lane); }
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const Watched& watched,
               std::span<Stream> streams, std::span<Point> shown) {
    truths_.assign(truths.begin(), truths.end());
    bounded_.perturb(lanes, truths, watched.agent(), streams, shown);
  }
  const std::vector<Point>& truths() const { return truths_; }

 private:
  WithinBallInStep bounded_;
  std::vector<Point> truths_;
};

}  // namespace

AgentEvaluation evaluate_agent(GridAgent& agent, GridAttack& attack, const ObservationBall& ball, long episodes,
                               std::uint64_t seed, const GridworldOptions& world_options) {
  AgentEvaluation out;
  ContinuousGridworld world(world_options);
  Watched watched(agent);
  WatchedAttack bounded(attack, ball);
  long held = 0;
  double area = 0;
  watched.looked = [&](std::span<const Lane> lanes) {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      ++out.steps;
      held += agent.holds(lanes[k], bounded.truths()[k]);
      area += agent.belief_size(lanes[k]);
    }
  };
  const auto start = std::chrono::steady_clock::now();
  const auto played = rollout_in_step(world, watched, bounded, paper_episodes(episodes, seed),
                                      [&](long, const StepRecord<Point, Point, Action>& record) {
                                        if (!record.terminal) return;
                                        const bool gold = gridworld::cell(record.next) == gridworld::Cell::gold;
                                        ++(gold ? out.gold : out.bomb);
                                      });
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const Episode& e : played) out.returns.push_back(e.total_reward);
  out.truth_in_belief = static_cast<double>(held) / static_cast<double>(out.steps);
  out.belief_size = area / static_cast<double>(out.steps);
  out.empty_intersections = agent.empty_intersections();
  return out;
}

EpisodeTrace trace_episode(GridAgent& agent, GridAttack& attack, const ObservationBall& ball, std::uint64_t seed,
                           long number, const GridworldOptions& world_options) {
  EpisodeTrace trace;
  trace.eps = ball.eps();
  trace.evaluation_seed = seed;
  trace.episode = number;
  ContinuousGridworld world(world_options);
  Watched watched(agent);
  WatchedAttack bounded(attack, ball);
  TraceBelief belief;
  watched.looked = [&](std::span<const Lane> lanes) { belief = agent.picture(lanes[0]); };
  EpisodesInStep options = paper_episodes(1, seed);
  options.first = number;
  rollout_in_step(world, watched, bounded, options,
                  [&](long, const StepRecord<Point, Point, Action>& record) { trace.add(record, belief); });
  return trace;
}

}  // namespace maximin::deep
