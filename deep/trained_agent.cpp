#include <maximin/deep/trained_agent.hpp>

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/agent_fields.hpp>
#include <maximin/deep/mean_state.hpp>
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

std::shared_ptr<Loss> make_loss(const AgentSpec& spec) {
  if (spec.loss == "sa") return std::make_shared<SaLoss>(options_of_loss(spec, spec.sa));
  if (spec.loss == "radial") return std::make_shared<RadialLoss>(options_of_loss(spec, spec.radial));
  if (spec.loss == "car") return std::make_shared<CarLoss>(options_of_loss(spec, spec.car));
  if (spec.loss == "wocar") {
    Stream rng = weights_stream(spec.training.seed, 1);
    return std::make_shared<WocarLoss>(options_of_loss(spec, spec.wocar), spec.network, rng);
  }
  TdLossOptions o;
  o.td.discount = spec.discount;
  o.aggregator = aggregator_named(spec.aggregator);
  o.td.double_q = spec.double_q;
  o.order = spec.target_order;
  return std::make_shared<TdLoss>(o);
}

std::filesystem::path times_file(std::filesystem::path agent) {
  if (agent.extension() == ".agent") agent.replace_extension();
  return agent += ".times.json";
}

}  // namespace

Acting acting_of(const AgentSpec& spec) {
  return {spec.belief,         spec.belief_states,          spec.aggregator,
          spec.random_actions, spec.particle_filter_belief, world_of(spec)};
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
  if (acting.belief == "ball")
    return std::make_shared<SetBeliefs>(SetBelief::ball, ball, acting.belief_states, acting.world);
  if (acting.belief == "exact")
    return std::make_shared<SetBeliefs>(SetBelief::exact, ball, acting.belief_states, acting.world);
  if (!particle_filter)
    throw InputError(fmt::format("belief: {}, expected an agent with a particle filter", acting.belief));
  const char* cell = particle_filter->options().cell == PfCell::gru ? "pf-gru" : "pf-lstm";
  if (acting.belief != cell) {
    throw InputError(
        fmt::format("belief: {}, expected {}, which this agent's particle filter is", acting.belief, cell));
  }
  return std::make_shared<PfRnnBelief>(particle_filter, acting.filter_belief);
}

std::unique_ptr<BeliefAgent> make_agent(const TrainedAgent& trained, const Acting& acting) {
  return std::make_unique<BeliefAgent>(trained.values(), make_belief(acting, trained.spec.eps, trained.particle_filter),
                                       aggregator_named(acting.aggregator), acting.random_actions);
}

std::string identity_of(const TrainedAgent& trained, const Acting& acting) {
  std::string belief = fmt::format("{} of {} states", acting.belief, acting.belief_states);
  if (trained.particle_filter) {
    PfBeliefOptions options = acting.filter_belief;
    belief = fmt::format("{} {:08x} {}", acting.belief, checksum_of(*trained.particle_filter),
                         FieldWriter::json_of(options).dump());
  }
  return fmt::format("{} {:08x}, {} of {}, random {:g}", trained.spec.name(), checksum_of(*trained.values()),
                     acting.aggregator, belief, acting.random_actions);
}

TrainedAgent untrained(const AgentSpec& spec) {
  Stream rng = weights_stream(spec.training.seed, 0);
  return {spec, std::make_shared<QNetwork>(spec.network, rng), make_loss(spec), nullptr};
}

PfRnnPtr untrained_filter(const AgentSpec& spec) {
  Stream rng = weights_stream(spec.training.seed, 2);
  return std::make_shared<PfRnn>(shape_of_filter(spec), rng);
}

void put_particle_filter(TensorFile& file, const TrainedAgent& agent) {
  if (!agent.particle_filter) return;
  put_module(file, "particle_filter", *agent.particle_filter);
}

void get_particle_filter(const TensorFile& file, TrainedAgent& agent) {
  if (!agent.spec.has_particle_filter()) return;
  agent.particle_filter = untrained_filter(agent.spec);
  get_module(file, "particle_filter", *agent.particle_filter);
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
