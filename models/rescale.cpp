#include <maximin/models/rescale.hpp>

#include <utility>

#include <maximin/theory/error.hpp>

namespace maximin {

Model<double> scale_rewards(const Model<double>& model, double factor) {
  const auto& mdp = model.mdp;
  FiniteMdpBuilder<double> builder(mdp.states(), mdp.actions(), mdp.discount());
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, factor * mdp.reward(s, a));
      for (const auto& next : mdp.successors(s, a)) builder.transition(s, a, next.target, next.probability);
    }
  }
  Model<double> scaled = model;
  scaled.mdp = std::move(builder).build();
  return scaled;
}

Model<double> scale_space(const Model<double>& model, double factor) {
  if (model.geometry.kind != Geometry<double>::Kind::points) {
    throw InputError("geometry: no points, expected points to scale");
  }
  Model<double> scaled = model;
  scaled.geometry.points *= factor;
  if (scaled.geometry.eps) *scaled.geometry.eps *= factor;
  return scaled;
}

Model<double> contract_kernel(const Model<double>& model, double t) {
  const auto& mdp = model.mdp;
  FiniteMdpBuilder<double> builder(mdp.states(), mdp.actions(), mdp.discount());
  for (Action a = 0; a < mdp.actions(); ++a) {
    Values<double> nu = Values<double>::Zero(mdp.states());
    for (State s = 0; s < mdp.states(); ++s) {
      for (const auto& next : mdp.successors(s, a)) nu[next.target] += next.probability / mdp.states();
    }
    for (State s = 0; s < mdp.states(); ++s) {
      Values<double> row = (1 - t) * nu;
      for (const auto& next : mdp.successors(s, a)) row[next.target] += t * next.probability;
      builder.reward(s, a, mdp.reward(s, a));
      for (State target = 0; target < mdp.states(); ++target) builder.transition(s, a, target, row[target]);
    }
  }
  Model<double> contracted = model;
  contracted.mdp = std::move(builder).build();
  return contracted;
}

}  // namespace maximin
