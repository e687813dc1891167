#include <maximin/deep/attacks/named_attack.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <maximin/deep/attacks/adaptive_director.hpp>
#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/director_training.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/network_search.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/pa_ad_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/attacks/through_defence_attack.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// What a director's file says of its training, beside what the director says of itself.
nlohmann::ordered_json training_of(const AttackSetting& setting, const AttackTarget& target, long frames) {
  nlohmann::ordered_json about{
      {"name", setting.name}, {"learned_against", target.identity}, {"frames", frames}, {"seed", setting.seed}};
  if (setting.name == "director") about["judge"] = checksum_of(*target.judge);
  return about;
}

/// Takes these fields out of the heading.
void expect_training(nlohmann::ordered_json& about, const nlohmann::ordered_json& training) {
  if (!about.is_object()) throw InputError("no attacker, expected what an attacker was taught");
  for (const auto& [what, expected] : training.items()) {
    const nlohmann::ordered_json found = about.contains(what) ? about[what] : nlohmann::ordered_json();
    about.erase(what);
    if (found == expected) continue;
    throw InputError(
        fmt::format("{} is {}, expected {}: an attacker is taught for one agent and setting; remove the file, or name "
                    "another",
                    what, found.dump(), expected.dump()));
  }
}

void expect_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  if (folder.empty() || std::filesystem::is_directory(folder)) return;
  throw InputError(fmt::format("{}: no such folder, expected one for {}", folder.string(), file.filename().string()));
}

/// Reads the director's file, or teaches it against the agent and writes it. False where it was interrupted.
bool learn(Director& director, GridAgent& victim, const AttackSetting& setting, const AttackTarget& target) {
  DirectorTraining training;
  training.seed = setting.seed;
  if (setting.quick) {
    training.frames = training.stretch_frames = 1'000;
    training.lanes = 32;
    training.evaluation_episodes = 4;
  }
  if (!setting.file.empty() && std::filesystem::exists(setting.file)) {
    try {
      TensorFile file = read_tensor_file(setting.file, "attacker");
      expect_training(file.about, training_of(setting, target, training.frames));
      director.load(file);
    } catch (const InputError& e) {
      const std::string what = e.what(), file = setting.file.string();
      throw InputError(what.starts_with(file) ? what : fmt::format("{}: {}", file, what));
    } catch (const nlohmann::json::exception&) {
      throw InputError(fmt::format("{}: no attacker, expected what an attacker was taught", setting.file.string()));
    }
    return true;
  }
  expect_folder_of(setting.file);
  bool stopped = false;
  train_director(director, victim, ContinuousGridworld(target.world), training, [&](const DirectorPoint& point) {
    const double share = std::min(1.0, static_cast<double>(point.frames) / static_cast<double>(training.frames));
    stopped = setting.progress && !setting.progress(share, std::min(point.sampled_return, point.greedy_return));
    return !stopped;
  });
  if (stopped) return false;
  // Whoever plays with it plays as its file would have it.
  if (setting.file.empty()) return true;
  TensorFile file = director.save();
  file.about.update(training_of(setting, target, training.frames));
  write_tensor_file(setting.file, file);
  return true;
}

std::shared_ptr<GridAttack> learned(const AttackSetting& setting, const AttackTarget& target) {
  const ObservationBall ball(setting.eps);
  std::shared_ptr<Director> director;
  if (setting.name == "director") {
    AdaptiveDirectorOptions options;
    options.director.seed = setting.seed;
    director = std::make_shared<AdaptiveDirector>(target.judge, ball, options);
  } else {
    PaAdOptions options;
    options.director.seed = setting.seed;
    director = std::make_shared<PaAdAttack>(target.values, ball, options);
  }
  // The paper's attacker knows the network and no belief.
  const std::unique_ptr<GridAgent> victim =
      setting.name == "pa-ad"
          ? std::make_unique<BeliefAgent>(target.values, std::make_shared<ObservedState>(), MeanAggregator{})
          : target.twin();
  return learn(*director, *victim, setting, target) ? director : nullptr;
}

/// The mean return that the attack leaves the agent, in episodes that neither training nor any table sees.
double left_by(GridAttack& attack, const AttackSetting& setting, const AttackTarget& target) {
  constexpr std::uint64_t trial_seed_bit = std::uint64_t{1} << 62U;
  const std::unique_ptr<GridAgent> agent = target.twin();
  const std::vector<double> returns =
      evaluate_agent(*agent, attack, ObservationBall(setting.eps), setting.quick ? 16 : 200,
                     setting.seed ^ trial_seed_bit, target.world)
          .returns;
  return std::accumulate(returns.begin(), returns.end(), 0.0) / static_cast<double>(returns.size());
}

/// Directors of several seeds, of which the strongest stays: one is not enough to judge an agent by. The first is the
/// `director` of the same seed.
std::shared_ptr<GridAttack> worst_of_directors(const AttackSetting& setting, const AttackTarget& target) {
  constexpr int directors = 3;
  constexpr std::uint64_t seeds_apart = 2'000'000;
  std::shared_ptr<GridAttack> worst;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < directors; ++k) {
    AttackSetting one = setting;
    one.name = "director";
    one.seed = setting.seed + static_cast<std::uint64_t>(k) * seeds_apart;
    if (!setting.file.empty()) {
      one.file.replace_filename(
          fmt::format("{}-{}{}", setting.file.stem().string(), k + 1, setting.file.extension().string()));
    }
    if (setting.progress) {
      one.progress = [&](double share, double reward) { return setting.progress((k + share) / directors, reward); };
    }
    const std::shared_ptr<GridAttack> director = learned(one, target);
    if (!director) return nullptr;
    const double left = left_by(*director, setting, target);
    if (worst && left >= least) continue;
    worst = director;
    least = left;
  }
  return worst;
}

}  // namespace

const std::vector<NamedAttack>& named_attacks() {
  static const std::vector<NamedAttack> attacks{
      {"none", "natural", Knowledge::truth, false, true},
      {"random", "random", Knowledge::truth},
      {"constant-offset", "constant offset", Knowledge::truth},
      {"pgd", "PGD", Knowledge::network, false, true},
      {"pgd-released", "PGD as released", Knowledge::network},
      {"pgd-restarts", "PGD from 10 starts", Knowledge::network},
      {"min-best", "MinBest", Knowledge::network, false, true},
      {"pgd-search", "PGD's objective by search", Knowledge::network},
      {"min-best-search", "MinBest's objective by search", Knowledge::network},
      {"pa-ad", "PA-AD", Knowledge::network, true, true},
      {"best-response", "best response", Knowledge::defence},
      {"best-response-steady", "best response, steady", Knowledge::defence},
      {"through-defence", "descent through the defence", Knowledge::defence},
      {"pa-ad-adaptive", "PA-AD against the whole defence", Knowledge::defence, true},
      {"director", "director against the whole defence", Knowledge::defence, true},
      {"directors", "the worst of three directors", Knowledge::defence, true},
  };
  return attacks;
}

const NamedAttack& attack_named(const std::string& name) {
  for (const NamedAttack& attack : named_attacks()) {
    if (attack.name == name) return attack;
  }
  throw InputError(fmt::format("attack: {}, expected {}", name, nearest_or_all(name, attack_names())));
}

std::vector<std::string> attack_names() {
  std::vector<std::string> names;
  for (const NamedAttack& attack : named_attacks()) names.push_back(attack.name);
  return names;
}

std::shared_ptr<GridAttack> make_attack(const AttackSetting& setting, const AttackTarget& target) {
  const std::string& name = attack_named(setting.name).name;
  const ObservationBall ball(setting.eps);
  if (name == "none") return std::make_shared<NoAttack>();
  if (name == "random") return std::make_shared<RandomAttack>(ball);
  if (name == "constant-offset") return std::make_shared<ConstantOffsetAttack>(ball);
  if (name.ends_with("-search")) {
    return std::make_shared<NetworkSearch>(target.values, ball, network_search_named(name));
  }
  if (name.starts_with("pgd") || name == "min-best") {
    return std::make_shared<GradientAttack>(target.values, ball, gradient_attack_named(name));
  }
  if (name.starts_with("best-response")) {
    BestResponseOptions options;
    options.steady = name == "best-response-steady";
    return std::make_shared<BestResponseAttack>(target.judge, ball, options);
  }
  if (name == "through-defence") {
    ThroughDefenceOptions options;
    options.unit = target.unit;
    return std::make_shared<ThroughDefenceAttack>(target.judge, ball, options);
  }
  return name == "directors" ? worst_of_directors(setting, target) : learned(setting, target);
}

}  // namespace maximin::deep
