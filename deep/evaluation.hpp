#pragma once

#include <cstdint>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/report/trace.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// How an agent did under an attack.
struct AgentEvaluation {
  std::vector<double> returns;   ///< total reward of each episode, in order of its number
  long gold = 0, bomb = 0;       ///< episodes that ended there; the others were cut by the horizon
  double truth_in_belief = 0;    ///< share of steps
  double belief_size = 0;        ///< mean area of a belief
  long empty_intersections = 0;  ///< beliefs that did not meet what was shown
  long steps = 0;
  double seconds = 0;  ///< of agent, attack and world together
};

/// Plays the paper's episodes, of 100 steps at most, undiscounted. Throws std::logic_error when the attack leaves the
/// ball.
AgentEvaluation evaluate_agent(GridAgent& agent, GridAttack& attack, const ObservationBall& ball, long episodes,
                               std::uint64_t seed, const GridworldOptions& world = {});

/// Episode `number` of the same, for pictures. The trace's agent, attack and training seed are left to the caller.
EpisodeTrace trace_episode(GridAgent& agent, GridAttack& attack, const ObservationBall& ball, std::uint64_t seed,
                           long number, const GridworldOptions& world = {});

}  // namespace maximin::deep
