#include <maximin/models/random_lipschitz_mdp.hpp>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/random_lipschitz_kernel.hpp>
#include <maximin/models/random_lipschitz_rewards.hpp>

namespace maximin {
namespace {

void require(bool holds, const char* option, double value, const char* expected) {
  if (!holds) throw InputError(fmt::format("{}: {}, expected {}", option, value, expected));
}

void check(const LipschitzMdpOptions& o) {
  require(o.states >= 1 && o.states <= 2000, "states", o.states, "1 to 2000");
  require(o.actions >= 1 && o.actions <= 1000, "actions", o.actions, "1 to 1000");
  require(o.discount >= 0 && o.discount < 1, "discount", o.discount, "0 <= discount < 1");
  require(o.eps >= 0 && std::isfinite(o.eps), "eps", o.eps, "a finite number >= 0");
  require(o.l_r >= 0 && std::isfinite(o.l_r), "l_r", o.l_r, "a finite number >= 0");
  require(o.l_p >= 0 && std::isfinite(o.l_p), "l_p", o.l_p, "a finite number >= 0");
  require(o.successors == 0 || o.successors >= 2, "successors", o.successors, "0 (dense) or at least 2");
  require(o.sharpness >= 0 && o.sharpness <= 1, "sharpness", o.sharpness, "0 to 1");
  require(o.action_gap >= 0, "action_gap", o.action_gap, "a number >= 0");
  if (o.reward_span) {
    require(*o.reward_span >= 0 && std::isfinite(*o.reward_span), "reward_span", *o.reward_span,
            "a finite number >= 0");
  }
}

FiniteMdp<double> assemble(const LipschitzMdpOptions& o, const QTable<double>& rewards,
                           const std::vector<QTable<double>>& kernel) {
  FiniteMdpBuilder<double> builder(o.states, o.actions, o.discount);
  for (State s = 0; s < o.states; ++s) {
    for (Action a = 0; a < o.actions; ++a) {
      builder.reward(s, a, rewards(s, a));
      const auto& rows = kernel[static_cast<std::size_t>(a)];
      for (State t = 0; t < o.states; ++t) {
        if (rows(s, t) > 0) builder.transition(s, a, t, rows(s, t));
      }
    }
  }
  return std::move(builder).build();
}

}  // namespace

Model<double> random_lipschitz_mdp(Metric<double>::Points points, const LipschitzMdpOptions& options, Stream& rng) {
  check(options);
  require(points.rows() == options.states, "points", static_cast<double>(points.rows()), "one for each state");
  const PairwiseDistances distances = pairwise_distances(Metric<double>::from_points(points, options.norm));
  const QTable<double> rewards = random_lipschitz_rewards(distances, options, rng);
  const std::vector<QTable<double>> kernel = random_lipschitz_kernel(distances, options, rng);

  Model<double> model{.mdp = assemble(options, rewards, kernel)};
  model.name = "random Lipschitz MDP";
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points = std::move(points);
  model.geometry.norm = options.norm;
  model.geometry.eps = options.eps;
  return model;
}

Model<double> random_lipschitz_mdp(const LipschitzMdpOptions& options, Stream& rng) {
  check(options);
  return random_lipschitz_mdp(random_points(options.layout, options.states, options.dimension, options.side, rng),
                              options, rng);
}

}  // namespace maximin
