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

/// A particle filter for the belief, trained in one go: it takes minutes, and the same seed gives the same filter. What
/// follows keeps it in its checkpoints. False where the hook stopped it.
bool train_particle_filter(TrainedAgent& agent, const TrainingHooks& hooks) {
  const PfTrainingOptions options = training_of_filter(agent.spec);
  const Stopwatch watch;
  agent.particle_filter = untrained_filter(agent.spec);
  const long frames_per_update = options.batch * options.window;
  if (hooks.begin) hooks.begin("belief model of " + agent.spec.name(), options.updates * frames_per_update);
  bool stopped = false;
  train_pf_rnn(*agent.particle_filter, options, [&](const PfTrainingProgress& progress) {
    if (progress.update % 20 != 0 || !hooks.stretch) return true;
    CurvePoint point;
    point.frames = progress.update * frames_per_update;
    point.mean_return = point.exploration = std::nan("");
    point.loss = progress.loss;
    stopped = !hooks.stretch(point);
    return !stopped;
  });
  agent.belief_seconds = watch.seconds();
  return !stopped;
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
    throw InputError(fmt::format("{}: no checkpoint, expected specification and seconds", path.string()));
  }
}

/// The checkpoint, if there is one, with what it holds besides the trainer's: seconds so far and the particle filter.
std::optional<TensorFile> read_checkpoint(const fs::path& path, TrainedAgent& agent) {
  if (!fs::exists(path)) return std::nullopt;
  TensorFile file = read_tensor_file(path, "training");
  reading(path, [&] {
    AgentSpec written;
    merge_json(written, file.about.at("specification"), "specification");
    if (!same_training(written, agent.spec)) {
      throw InputError("a training of another specification, expected the same; remove it or train in another folder");
    }
    get_particle_filter(file, agent);
    agent.belief_seconds = file.about.at("belief_seconds").get<double>();
    agent.training_seconds = file.about.at("training_seconds").get<double>();
  });
  return file;
}

void write_checkpoint(const fs::path& path, const TrainedAgent& agent, const Trainer& trainer, double seconds) {
  TensorFile file{"training", {}, {}};
  file.about["specification"] = to_json(agent.spec);
  file.about["belief_seconds"] = agent.belief_seconds;
  file.about["training_seconds"] = seconds;
  put_particle_filter(file, agent);
  trainer.save(file);
  write_tensor_file(path, file);
}

/// What is trained before the agent: the weights that it begins with, and its particle filter unless it has one.
bool prepare(TrainedAgent& agent, const fs::path& folder, torch::Device device, const Effort& effort,
             const TrainingHooks& hooks) {
  const AgentSpec& spec = agent.spec;
  if (const auto first = beginning_of(spec, effort)) {
    const auto start = train_agent(*first, folder, device, effort, hooks);
    if (!start) return false;
    agent.q->copy_from(*start->q);
    if (auto* wocar = dynamic_cast<WocarLoss*>(agent.loss.get())) wocar->start_from(*start->q);
  }
  const bool lacks_filter = spec.has_particle_filter() && !agent.particle_filter;
  return !lacks_filter || train_particle_filter(agent, hooks);
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
  if (!prepare(agent, folder, device, effort, hooks)) return std::nullopt;

  Trainer trainer(spec.training, training_parts(agent, device));
  if (checkpoint) reading(files.checkpoint, [&] { trainer.load(*checkpoint); });
  const double before = agent.training_seconds;
  const Stopwatch watch;
  TrainingLogWriter log(files.log, training_columns(), static_cast<double>(trainer.frames()));
  if (hooks.begin) hooks.begin(spec.name(), spec.training.frames);
  while (!trainer.done()) {
    const CurvePoint point = trainer.stretch();
    log.append(training_row(point));
    const bool go_on = !hooks.stretch || hooks.stretch(point);
    if (!trainer.done()) write_checkpoint(files.checkpoint, agent, trainer, before + watch.seconds());
    if (!go_on && !trainer.done()) return std::nullopt;
  }
  agent.training_seconds = before + watch.seconds();
  agent.q->to(torch::kCPU);
  for (const auto& module : agent.loss->modules()) module->to(torch::kCPU);
  write_agent(files.agent, agent);
  fs::remove(files.checkpoint, ignored);
  return agent;
}

}  // namespace maximin::deep
