#pragma once

#include <algorithm>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// How observations are chosen within the ball.
enum class Shown { random, farthest, smallest_belief };

/// Plays `steps` random actions and tells whether the true state was in the belief throughout. The filter has `reset`
/// and `update` of the BeliefModel concept; `inspect(truth, observation, belief)` sees every step and may end it all by
/// returning false.
template <class Filter, class Inspect>
bool keeps_the_truth(Filter filter, const FiniteMdp<double>& mdp, const Perturbation<double>& balls, Shown shown,
                     int steps, Stream& rng, Inspect inspect) {
  State truth = rng.below(mdp.states());
  Action action = 0;
  for (int step = 0; step < steps; ++step) {
    const auto believed = [&](State observation) {
      Filter probe = filter;
      return step == 0 ? probe.reset(observation) : probe.update(action, observation);
    };
    const auto ball = balls.ball(truth);
    State observation = ball[static_cast<std::size_t>(rng.below(static_cast<int>(ball.size())))];
    if (shown == Shown::farthest) {
      observation = *std::max_element(ball.begin(), ball.end(), [&](State x, State y) {
        return balls.metric().distance(truth, x) < balls.metric().distance(truth, y);
      });
    } else if (shown == Shown::smallest_belief) {
      observation = *std::min_element(ball.begin(), ball.end(),
                                      [&](State x, State y) { return believed(x).size() < believed(y).size(); });
    }
    const Belief& belief = step == 0 ? filter.reset(observation) : filter.update(action, observation);
    if (!std::binary_search(belief.begin(), belief.end(), truth)) return false;
    if (!inspect(truth, observation, belief)) return false;
    action = rng.below(mdp.actions());
    const auto row = mdp.successors(truth, action);
    truth = row[static_cast<std::size_t>(rng.below(static_cast<int>(row.size())))].target;
  }
  return true;
}

template <class Filter>
bool keeps_the_truth(Filter filter, const FiniteMdp<double>& mdp, const Perturbation<double>& balls, Shown shown,
                     int steps, Stream& rng) {
  return keeps_the_truth(std::move(filter), mdp, balls, shown, steps, rng,
                         [](State, State, const Belief&) { return true; });
}

}  // namespace maximin
