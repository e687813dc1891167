#pragma once

#include <vector>

#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// The kernel of a random Lipschitz MDP: one |S| x |S| stochastic matrix per action, whose smallest Lipschitz constant
/// (largest |P(s'|s,a) - P(s'|t,a)| / d(s,t)) is options.l_p. Uses actions, l_p, successors and sharpness.
/// Throws InputError when l_p exceeds 1/d_min, which no kernel can.
std::vector<QTable<double>> random_lipschitz_kernel(const PairwiseDistances& distances,
                                                    const LipschitzMdpOptions& options, Stream& rng);

}  // namespace maximin
