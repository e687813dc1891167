#pragma once

#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// The rewards of a random Lipschitz MDP, |S| x |A|, whose smallest Lipschitz constant (largest |R(s,a) - R(t,a)| /
/// d(s,t)) is options.l_r and whose span is options.reward_span, if given. Uses actions, l_r, sign, reward_span and
/// action_gap. Throws InputError when no function has both the constant and the span; says what is in reach.
QTable<double> random_lipschitz_rewards(const PairwiseDistances& distances, const LipschitzMdpOptions& options,
                                        Stream& rng);

}  // namespace maximin
