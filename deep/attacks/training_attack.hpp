#pragma once

#include <memory>
#include <string>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// Whom an agent is trained against: none, random, pgd (the paper's, on the network being trained), pgd-released,
/// min-best, or mixed.
/// Mixed draws one for each episode: none, random, a corner of the ball kept all the time, PGD, MinBest, and sampled
/// best response through the whole defence, so that no single attack is learned by heart. Best responses are judged by
/// the values as they are when training begins. What it shows is checked to lie in the ball. Throws InputError on
/// another name.
std::shared_ptr<GridAttack> training_attack(const std::string& name, const ObservationBall& ball,
                                            const std::shared_ptr<ActionValueModule>& trained, const QNetwork& judge);

}  // namespace maximin::deep
