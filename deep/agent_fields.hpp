#pragma once

#include <array>

#include <maximin/deep/agent_spec.hpp>
#include <maximin/deep/option_fields.hpp>

/// The fields of a specification by their names in files, and what the values of its enumerations are called there.
namespace maximin::deep {

constexpr auto words_of(TargetOrder) {
  return std::to_array({"max-of-aggregate", "aggregate-of-max", "belief-greedy"});
}
constexpr auto words_of(PerturbationRamp::Shape) {
  return std::to_array({"linear", "smoothed"});
}
constexpr auto words_of(BoundMethod) {
  return std::to_array({"ibp", "crown-ibp", "crown", "tightest"});
}
constexpr auto words_of(RadialOverlap) {
  return std::to_array({"separate-bounds", "merged-difference"});
}
constexpr auto words_of(CarWeights) {
  return std::to_array({"absolute-error", "huber"});
}
constexpr auto words_of(WocarRobustTerm) {
  return std::to_array({"bad-ends", "both-ends", "important-hinge", "none"});
}
constexpr auto words_of(PfNormalisation) {
  return std::to_array({"layer", "batch", "none"});
}
constexpr auto words_of(PfReadOut) {
  return std::to_array({"residual", "absolute"});
}
constexpr auto words_of(PfResampling) {
  return std::to_array({"systematic", "multinomial"});
}
constexpr auto words_of(PfWeighing) {
  return std::to_array({"bilinear", "linear"});
}
constexpr auto words_of(PfTarget) {
  return std::to_array({"acted-on", "previous"});
}

template <class Visitor>
void visit_fields(ReplayOptions& o, Visitor& visit) {
  visit("capacity", o.capacity);
  visit("prioritised", o.prioritised);
  visit("alpha", o.alpha);
  visit("beta_start", o.beta_start);
}

template <class Visitor>
void visit_fields(QNetworkShape& o, Visitor& visit) {
  visit("inputs", o.inputs);
  visit("hidden", o.hidden);
  visit("actions", o.actions);
  visit("input_centre", o.input_centre);
  visit("input_scale", o.input_scale);
  visit("waves", o.waves);
}

template <class Visitor>
void visit_fields(TrainOptions& o, Visitor& visit) {
  visit("seed", o.seed);
  visit("frames", o.frames);
  visit("lanes", o.lanes);
  visit("horizon", o.horizon);
  visit("truncation_is_terminal", o.truncation_is_terminal);
  visit("frames_per_update", o.frames_per_update);
  visit("batch", o.batch);
  visit("learning_rate", o.learning_rate);
  visit("final_learning_rate", o.final_learning_rate);
  visit("adam_eps", o.adam_eps);
  visit("gradient_clip", o.gradient_clip);
  visit("warm_up", o.warm_up);
  visit("averaged_share", o.averaged_share);
  visit("explore_start", o.explore_start);
  visit("explore_end", o.explore_end);
  visit("explore_frames", o.explore_frames);
  visit("target_every", o.target_every);
  visit("reward_scale", o.reward_scale);
  visit("stretch_frames", o.stretch_frames);
  bool stale = o.bootstrap == BootstrapBelief::current;
  visit("bootstrap_current_belief", stale);
  o.bootstrap = stale ? BootstrapBelief::current : BootstrapBelief::next;
  visit("learn_from_belief", o.learn_from_belief);
  visit("replay", o.replay);
}

// Of baselines and particle filters all but what follows from other fields: radius, discount, seed, cell.
template <class Visitor>
void visit_fields(PerturbationRamp& o, Visitor& visit) {
  visit("start", o.start);
  visit("end", o.end);
  visit("shape", o.shape);
}

template <class Visitor>
void visit_fields(SaLossOptions& o, Visitor& visit) {
  visit("huber", o.td.huber);
  visit("ramp", o.ramp);
  visit("kappa", o.kappa);
  visit("margin", o.margin);
  visit("bounds", o.bounds);
}

template <class Visitor>
void visit_fields(RadialLossOptions& o, Visitor& visit) {
  visit("huber", o.td.huber);
  visit("ramp", o.ramp);
  visit("kappa", o.kappa);
  visit("ramp_kappa", o.ramp_kappa);
  visit("bounds", o.bounds);
  visit("overlap", o.overlap);
}

template <class Visitor>
void visit_fields(CarLossOptions& o, Visitor& visit) {
  visit("huber", o.td.huber);
  visit("ramp", o.ramp);
  visit("lambda", o.lambda);
  visit("weights", o.weights);
  visit("bounds", o.bounds);
  visit("clean_share", o.clean_share);
}

template <class Visitor>
void visit_fields(WocarLossOptions& o, Visitor& visit) {
  visit("huber", o.td.huber);
  visit("ramp", o.ramp);
  visit("worst_share", o.worst_share);
  visit("kappa", o.kappa);
  visit("ramp_kappa", o.ramp_kappa);
  visit("robust_term", o.robust_term);
  visit("hinge_margin", o.hinge_margin);
  visit("reach_bounds", o.reach_bounds);
  visit("robust_bounds", o.robust_bounds);
  visit("critic_eps", o.critic_eps);
  visit("critic_floor", o.critic_floor);
  visit("reach_of_acting_values", o.reach_of_acting_values);
  visit("reach_at_state", o.reach_at_state);
  visit("critic_target_network", o.critic_target_network);
}

template <class Visitor>
void visit_fields(PfRnnOptions& o, Visitor& visit) {
  visit("particles", o.particles);
  visit("hidden", o.hidden);
  visit("embedding", o.embedding);
  visit("alpha", o.alpha);
  visit("normalisation", o.normalisation);
  visit("read_out", o.read_out);
  visit("resampling", o.resampling);
  visit("weighing", o.weighing);
  visit("read_before_resampling", o.read_before_resampling);
  visit("cells", o.cells);
  visit("innovation", o.innovation);
  visit("one_hot_actions", o.one_hot_actions);
}

template <class Visitor>
void visit_fields(PfTrainingOptions& o, Visitor& visit) {
  visit("walk", o.walk);
  visit("deception", o.deception);
  visit("actions_drawn", o.actions_drawn);
  visit("horizon", o.horizon);
  visit("target", o.target);
  visit("updates", o.updates);
  visit("batch", o.batch);
  visit("window", o.window);
  visit("particles", o.particles);
  visit("learning_rate", o.learning_rate);
  visit("decay", o.decay);
  visit("clip", o.clip);
  visit("dropout", o.dropout);
  visit("mean_weight", o.mean_weight);
  visit("elbo_weight", o.elbo_weight);
  visit("kernel", o.kernel);
  visit("time_weight", o.time_weight);
}

template <class Visitor>
void visit_fields(PfBeliefOptions& o, Visitor& visit) {
  visit("correct", o.correct);
  visit("slack", o.slack);
  visit("hull_margin", o.hull_margin);
  visit("forgets", o.forgets);
}

template <class Visitor>
void visit_fields(AgentSpec& o, Visitor& visit) {
  visit("kind", o.kind);
  visit("eps", o.eps);
  visit("network", o.network);
  visit("loss", o.loss);
  if (o.loss == "sa") visit("loss_options", o.sa);
  if (o.loss == "radial") visit("loss_options", o.radial);
  if (o.loss == "car") visit("loss_options", o.car);
  if (o.loss == "wocar") visit("loss_options", o.wocar);
  visit("belief", o.belief);
  visit("belief_trajectories", o.belief_trajectories);
  if (o.has_particle_filter()) {
    visit("particle_filter", o.particle_filter);
    visit("particle_filter_training", o.particle_filter_training);
    visit("particle_filter_belief", o.particle_filter_belief);
  }
  visit("belief_states", o.belief_states);
  visit("training_belief_states", o.training_belief_states);
  visit("aggregator", o.aggregator);
  visit("double_q", o.double_q);
  visit("target_order", o.target_order);
  visit("discount", o.discount);
  visit("train_attack", o.train_attack);
  visit.rare("start_anywhere", o.start_anywhere);
  visit("start_from", o.start_from);
  visit("random_actions", o.random_actions);
  visit("training", o.training);
}

}  // namespace maximin::deep
