#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/attacks/training_attack.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/deep/pf_rnn_training.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/models/files/file_lock.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

namespace fs = std::filesystem;

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The agent of that file, if there is one and it is of this specification.
std::optional<TrainedAgent> finished(const AgentSpec& spec, const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  TrainedAgent agent = read_agent(path);
  if (same_training(agent.spec, spec)) return agent;
  throw InputError(
      fmt::format("{}: an agent of another specification, expected to find it as it would be trained now; "
                  "remove it or train in another folder",
                  path.string()));
}

struct Files {
  fs::path agent, log, checkpoint;
  Files(const fs::path& folder, const std::string& name)
      : agent(folder / (name + ".agent")), log(folder / (name + ".csv")), checkpoint(folder / (name + ".training")) {}
};

/// Does something with a checkpoint; what is wrong with it is said with its name.
void reading(const fs::path& path, const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", path.string(), e.what()));
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format(
        "{}: no checkpoint of this version, expected specification, part and seconds; remove it to begin anew",
        path.string()));
  }
}

/// What of a pipeline a checkpoint is of.
constexpr const char* filter_part = "particle filter";
constexpr const char* network_part = "network";

/// The checkpoint, if there is one, with what it holds besides the trainer's: seconds so far and, when that is trained,
/// the particle filter.
std::optional<TensorFile> read_checkpoint(const fs::path& path, TrainedAgent& agent) {
  if (!fs::exists(path)) return std::nullopt;
  TensorFile file = read_tensor_file(path, "training");
  reading(path, [&] {
    AgentSpec written;
    merge_json(written, file.about.at("specification"), "specification");
    if (!same_training(written, agent.spec)) {
      throw InputError("a training of another specification, expected the same; remove it or train in another folder");
    }
    const auto part = file.about.at("part").get<std::string>();
    if (part == network_part) {
      get_particle_filter(file, agent);
    } else if (part != filter_part || !agent.spec.has_particle_filter()) {
      throw InputError(fmt::format("its part is \"{}\", expected one of this agent's; remove it to begin anew", part));
    }
    agent.belief_seconds = file.about.at("belief_seconds").get<double>();
    agent.training_seconds = file.about.at("training_seconds").get<double>();
  });
  return file;
}

/// `about` tells the agent's specification and seconds.
void write_checkpoint(const fs::path& path, const TrainedAgent& about, const char* part,
                      const std::function<void(TensorFile&)>& save) {
  TensorFile file{"training", {}, {}};
  file.about["specification"] = to_json(about.spec);
  file.about["part"] = part;
  file.about["belief_seconds"] = about.belief_seconds;
  file.about["training_seconds"] = about.training_seconds;
  save(file);
  write_tensor_file(path, file);
}

constexpr long updates_told = 20, updates_kept = 200;

/// The particle filter of the agent's belief. What follows keeps it in its own checkpoints. False where the hook
/// stopped it.
bool train_particle_filter(TrainedAgent& agent, const fs::path& path, const TensorFile* checkpoint,
                           const TrainingHooks& hooks) {
  const PfTrainingOptions options = training_of_filter(agent.spec);
  agent.particle_filter = untrained_filter(agent.spec);
  PfTrainer trainer(agent.particle_filter, options);
  if (checkpoint) reading(path, [&] { trainer.load(*checkpoint); });
  const double before = agent.belief_seconds;
  const Stopwatch watch;
  const auto keep = [&] {
    agent.belief_seconds = before + watch.seconds();
    write_checkpoint(path, agent, filter_part, [&](TensorFile& file) { trainer.save(file); });
  };
  const long frames_per_update = options.batch * options.window;
  if (hooks.begin) hooks.begin("belief model of " + agent.spec.name(), options.updates * frames_per_update);
  while (!trainer.done()) {
    const PfTrainingProgress now = trainer.update();
    if (now.update % updates_kept == 0) keep();
    if (now.update % updates_told != 0 || !hooks.stretch) continue;
    CurvePoint point;
    point.frames = now.update * frames_per_update;
    point.mean_return = point.exploration = std::nan("");
    point.loss = now.loss;
    if (!hooks.stretch(point)) {
      keep();
      return false;
    }
  }
  keep();
  agent.particle_filter->eval();
  return true;
}

/// The agent's own network. False where the hook stopped it.
bool train_network(TrainedAgent& agent, const Files& files, const TensorFile* checkpoint, torch::Device device,
                   const TrainingHooks& hooks) {
  Trainer trainer(agent.spec.training, training_parts(agent, device));
  if (checkpoint) reading(files.checkpoint, [&] { trainer.load(*checkpoint); });
  const double before = agent.training_seconds;
  const Stopwatch watch;
  TrainingLogWriter log(files.log, training_columns(), static_cast<double>(trainer.frames()));
  if (hooks.begin) hooks.begin(agent.spec.name(), agent.spec.training.frames);
  while (!trainer.done()) {
    const CurvePoint point = trainer.stretch();
    log.append(training_row(point));
    agent.training_seconds = before + watch.seconds();
    const bool go_on = !hooks.stretch || hooks.stretch(point);
    if (trainer.done()) break;
    write_checkpoint(files.checkpoint, agent, network_part, [&](TensorFile& file) {
      put_particle_filter(file, agent);
      trainer.save(file);
    });
    if (!go_on) return false;
  }
  return true;
}

/// What is trained before the agent: the weights that it begins with, and its particle filter unless it has one.
bool prepare(TrainedAgent& agent, const fs::path& folder, torch::Device device, const Effort& effort,
             const TrainingHooks& hooks) {
  const AgentSpec& spec = agent.spec;
  const auto first = beginning_of(spec, effort);
  if (!first) return true;
  const auto start = train_agent(*first, folder, device, effort, hooks);
  if (!start) return false;
  agent.q->copy_from(*start->q);
  if (auto* wocar = dynamic_cast<WocarLoss*>(agent.loss.get())) wocar->start_from(*start->q);
  return true;
}

}  // namespace

std::vector<std::string> training_columns() {
  return {"frames", "updates", "episodes", "return", "loss", "exploration", "truth in belief", "belief size"};
}

std::vector<std::optional<double>> training_row(const CurvePoint& p) {
  const auto number = [](double v) { return std::isfinite(v) ? std::optional<double>(v) : std::nullopt; };
  return {static_cast<double>(p.frames),
          static_cast<double>(p.updates),
          static_cast<double>(p.episodes),
          number(p.mean_return),
          number(p.loss),
          number(p.exploration),
          number(p.believed),
          number(p.belief_size)};
}

TrainingParts training_parts(const TrainedAgent& agent, torch::Device device) {
  const AgentSpec& spec = agent.spec;
  Acting acting = acting_of(spec);
  acting.belief_states = spec.training_belief_states;
  TrainingParts parts;
  parts.online = agent.q;
  parts.belief = make_belief(acting, spec.eps, agent.particle_filter);
  parts.aggregator = aggregator_named(spec.aggregator);
  parts.attack = training_attack(spec.train_attack, ObservationBall(spec.eps), agent.values_in_rewards(), *agent.q);
  parts.loss = agent.loss;
  parts.world = std::make_shared<GridworldPlane>(ContinuousGridworld(world_of(spec)));
  parts.device = device;
  return parts;
}

std::optional<TrainedAgent> train_agent(const AgentSpec& spec, const fs::path& folder, torch::Device device,
                                        const Effort& effort, const TrainingHooks& hooks) {
  const Files files(folder, spec.name());
  std::error_code ignored;
  if (auto done = finished(spec, files.agent)) {
    fs::remove(files.checkpoint, ignored);  // of a run that ended between writing the agent and this
    return done;
  }
  make_folder(folder);
  const FileLock one_at_a_time(files.agent);
  TrainedAgent agent = untrained(spec);
  const auto checkpoint = read_checkpoint(files.checkpoint, agent);
  const auto of_part = [&](const char* part) { return checkpoint && checkpoint->about["part"] == part; };
  if (!prepare(agent, folder, device, effort, hooks)) return std::nullopt;
  if (spec.has_particle_filter() && !of_part(network_part) &&
      !train_particle_filter(agent, files.checkpoint, of_part(filter_part) ? &*checkpoint : nullptr, hooks)) {
    return std::nullopt;
  }
  if (!train_network(agent, files, of_part(network_part) ? &*checkpoint : nullptr, device, hooks)) return std::nullopt;
  agent.q->to(torch::kCPU);
  for (const auto& module : agent.loss->modules()) module->to(torch::kCPU);
  write_agent(files.agent, agent);
  fs::remove(files.checkpoint, ignored);
  return agent;
}

}  // namespace maximin::deep
