#include <maximin/deep/trained_agent.hpp>

#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/losses/car_loss.hpp>
#include <maximin/deep/losses/radial_loss.hpp>
#include <maximin/deep/losses/sa_loss.hpp>
#include <maximin/deep/losses/td_loss.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/deep/mean_state.hpp>
#include <maximin/deep/pf_rnn_belief.hpp>
#include <maximin/deep/pf_rnn_file.hpp>
#include <maximin/deep/report/json_fields.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// Networks begin with weights from streams of their own, which no episode draws from.
Stream weights_stream(std::uint64_t seed, std::uint64_t which) {
  return Stream(seed, (std::uint64_t{1} << 62U) + which);
}

/// The losses with their papers' forms but for these: Radial-DQN, CAR-DQN and WocaR-DQN have CROWN's bounds, for with
/// intervals alone they unlearn the Gridworld, and Radial-DQN's overlap is of merged bounds of differences.
template <class Options>
Options baseline_options(const AgentSpec& spec) {
  Options o;
  o.td.discount = spec.discount;
  o.td.double_q = spec.double_q;
  o.ramp.eps = spec.eps;
  return o;
}

std::shared_ptr<Loss> make_loss(const AgentSpec& spec) {
  if (spec.loss == "sa") return std::make_shared<SaLoss>(baseline_options<SaLossOptions>(spec));
  if (spec.loss == "radial") {
    auto o = baseline_options<RadialLossOptions>(spec);
    o.bounds = BoundMethod::crown;
    o.overlap = RadialOverlap::merged_difference;
    return std::make_shared<RadialLoss>(o);
  }
  if (spec.loss == "car") {
    auto o = baseline_options<CarLossOptions>(spec);
    o.bounds = BoundMethod::crown;
    return std::make_shared<CarLoss>(o);
  }
  if (spec.loss == "wocar") {
    auto o = baseline_options<WocarLossOptions>(spec);
    o.reach_bounds = o.robust_bounds = BoundMethod::crown;
    Stream rng = weights_stream(spec.training.seed, 1);
    return std::make_shared<WocarLoss>(o, spec.network, rng);
  }
  TdLossOptions o;
  o.discount = spec.discount;
  o.aggregator = aggregator_named(spec.aggregator);
  o.double_q = spec.double_q;
  if (spec.target_order == "aggregate-of-max") o.order = TargetOrder::aggregate_of_max;
  return std::make_shared<TdLoss>(o);
}

std::filesystem::path times_file(std::filesystem::path agent) {
  if (agent.extension() == ".agent") agent.replace_extension();
  return agent += ".times.json";
}

}  // namespace

Acting acting_of(const AgentSpec& spec) {
  return {spec.belief, spec.belief_states, spec.aggregator, spec.random_actions};
}

Acting acting_of(const AgentSpec& spec, const ActingChange& change) {
  Acting acting = acting_of(spec);
  if (!change.belief.empty() && change.belief != spec.belief) {
    acting.belief = change.belief;
    acting.belief_states = Acting{}.belief_states;
  }
  if (!change.aggregator.empty()) acting.aggregator = change.aggregator;
  if (change.random_actions >= 0) acting.random_actions = change.random_actions;
  return acting;
}

std::shared_ptr<LaneBelief> make_belief(const Acting& acting, double eps, const PfRnnPtr& particle_filter) {
  if (acting.belief.ends_with("-mean")) {
    Acting whole = acting;
    whole.belief.resize(whole.belief.size() - std::string_view("-mean").size());
    return std::make_shared<MeanState>(make_belief(whole, eps, particle_filter));
  }
  const ObservationBall ball(eps);
  if (acting.belief == "observed") return std::make_shared<ObservedState>();
  if (acting.belief == "ball") return std::make_shared<SetBeliefs>(SetBelief::ball, ball, acting.belief_states);
  if (acting.belief == "exact") return std::make_shared<SetBeliefs>(SetBelief::exact, ball, acting.belief_states);
  if (!particle_filter)
    throw InputError(fmt::format("belief: {}, expected an agent with a particle filter", acting.belief));
  const char* cell = particle_filter->options().cell == PfCell::gru ? "pf-gru" : "pf-lstm";
  if (acting.belief != cell) {
    throw InputError(
        fmt::format("belief: {}, expected {}, which this agent's particle filter is", acting.belief, cell));
  }
  return std::make_shared<PfRnnBelief>(particle_filter);
}

std::unique_ptr<BeliefAgent> make_agent(const TrainedAgent& trained, const Acting& acting) {
  return std::make_unique<BeliefAgent>(trained.values(), make_belief(acting, trained.spec.eps, trained.particle_filter),
                                       aggregator_named(acting.aggregator), acting.random_actions);
}

std::string identity_of(const TrainedAgent& trained, const Acting& acting) {
  const std::uint32_t filter = trained.particle_filter ? checksum_of(*trained.particle_filter) : 0;
  return fmt::format("{} {:08x} {:08x}, {} of {}, random {:g}", trained.spec.name(), checksum_of(*trained.values()),
                     filter, acting.aggregator, acting.belief, acting.random_actions);
}

TrainedAgent untrained(const AgentSpec& spec) {
  Stream rng = weights_stream(spec.training.seed, 0);
  return {spec, std::make_shared<QNetwork>(spec.network, rng), make_loss(spec), nullptr};
}

void put_particle_filter(TensorFile& file, const TrainedAgent& agent) {
  if (!agent.particle_filter) return;
  std::ostringstream bytes;
  save_pf_rnn(bytes, *agent.particle_filter);
  file.tensors["particle_filter"] = tensor_of_bytes(bytes.str());
}

void get_particle_filter(const TensorFile& file, TrainedAgent& agent) {
  if (!agent.spec.has_particle_filter()) return;
  std::istringstream bytes(bytes_of_tensor(file.at("particle_filter")));
  agent.particle_filter = load_pf_rnn(bytes, "particle_filter");
}

void write_agent(const std::filesystem::path& path, const TrainedAgent& agent) {
  TensorFile file{"agent", {}, {}};
  file.about["specification"] = to_json(agent.spec);
  put_module(file, "q", *agent.q);
  const auto modules = agent.loss->modules();
  for (std::size_t i = 0; i < modules.size(); ++i) put_module(file, fmt::format("loss{}", i), *modules[i]);
  put_particle_filter(file, agent);
  const nlohmann::ordered_json times{{"training_seconds", agent.training_seconds},
                                     {"belief_seconds", agent.belief_seconds}};
  write_file(times_file(path), readable_json(times), Overwrite::replace);
  write_tensor_file(path, file);
}

TrainedAgent read_agent(const std::filesystem::path& path) {
  const TensorFile file = read_tensor_file(path, "agent");
  if (!file.about.is_object() || !file.about.contains("specification")) {
    throw InputError(fmt::format("{}: no specification, expected an agent", path.string()));
  }
  AgentSpec spec;
  merge_json(spec, file.about["specification"], path.string());
  TrainedAgent agent = untrained(spec);
  try {
    get_module(file, "q", *agent.q);
    const auto modules = agent.loss->modules();
    for (std::size_t i = 0; i < modules.size(); ++i) get_module(file, fmt::format("loss{}", i), *modules[i]);
    get_particle_filter(file, agent);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", path.string(), e.what()));
  }
  if (const std::filesystem::path times = times_file(path); std::filesystem::exists(times)) {
    const nlohmann::ordered_json json = read_json_file(times, "training_seconds and belief_seconds");
    const Fields fields(json, times.string());
    agent.training_seconds = fields.number("training_seconds");
    agent.belief_seconds = fields.number("belief_seconds");
  }
  return agent;
}

}  // namespace maximin::deep
