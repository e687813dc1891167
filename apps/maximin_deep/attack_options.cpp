#include <maximin/apps/maximin_deep/attack_options.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

CLI::Validator aggregator_name() {
  const auto wrong = [](const std::string& text) -> std::string {
    try {
      deep::aggregator_named(text);
      return {};
    } catch (const InputError& e) {
      return e.what();
    }
  };
  return CLI::Validator(wrong, "");
}

}  // namespace

void add_attack_options(CLI::App& sub, AttackedAgent& o) {
  sub.add_option("--eps", o.eps, "Radius of the attack's ball; what the agent was trained for unless given")
      ->check(real_number({.low = 0, .high = 5}));
  sub.add_option(
      "--judge", o.judge,
      "Agent file whose values adaptive attacks go by; unless given, the vanilla agent beside the file that judges in "
      "tables (seed 1000000 + its own), else that of its own seed, else the agent itself");
  sub.add_option("--belief", o.change.belief,
                 "In place of the agent's own: observed, ball, exact, pf-lstm, pf-gru; X-mean: the mean of X")
      ->check(one_of(deep::belief_names()));
  sub.add_option("--aggregator", o.change.aggregator, "In place of its own: min, mean, soft-min:BETA, cvar:ALPHA")
      ->check(aggregator_name());
  sub.add_option("--random-actions", o.change.random_actions, "Share of random actions, in place of its own")
      ->check(real_number({.low = 0, .high = 1}));
  sub.add_option("--attack-seed", o.attack_seed, "Seed of a learned attack's training; 1 unless given")
      ->check(seed_number());
  sub.add_option("--attacker", o.attacker, "File of a learned attack: read where it exists, else written");
  sub.add_flag("--quick", o.quick, "Learned attacks learn for seconds");
}

void expect_options_used(const AttackedAgent& o, const std::vector<std::string>& attacks) {
  const auto any = [&](auto&& is) {
    return std::any_of(attacks.begin(), attacks.end(),
                       [&](const std::string& name) { return is(deep::attack_named(name)); });
  };
  const bool learned = any([](const deep::NamedAttack& a) { return a.learned; });
  if (!learned && (o.attack_seed || !o.attacker.empty())) {
    throw InputError(fmt::format("{}: no attack here learns, expected one that does, e.g. --attack director",
                                 o.attack_seed ? "--attack-seed" : "--attacker"));
  }
  if (!o.judge.empty() && !any([](const deep::NamedAttack& a) { return a.knows == deep::Knowledge::defence; })) {
    throw InputError(
        "--judge: no attack here goes by it, expected one on the whole defence, e.g. --attack best-response");
  }
}

void note_if_quick(const AttackedAgent& o) {
  if (o.quick) note("--quick: learned attacks learn for seconds, to see that it works; they are weak");
}

namespace {

/// The agent file that an attack on the whole defence goes by: what is named, else beside the agent the vanilla one
/// that judges in tables, which no training saw, or that of the agent's own seed, where there is one.
std::filesystem::path judge_of(const AttackedAgent& o, const deep::AgentSpec& spec) {
  if (!o.judge.empty()) return o.judge;
  for (const std::uint64_t seed : {deep::judge_seed(spec.training.seed), spec.training.seed}) {
    std::filesystem::path vanilla = o.file.parent_path() / fmt::format("dqn-seed{}.agent", seed);
    if (std::filesystem::exists(vanilla)) return vanilla;
  }
  return {};
}

}  // namespace

Match prepare_match(const AttackedAgent& o) {
  Match match;
  match.trained = std::make_unique<deep::TrainedAgent>(deep::read_agent(o.file));
  deep::AgentSpec& spec = match.trained->spec;
  match.eps = o.eps >= 0 ? o.eps + 0.0 : spec.eps;  // -0 is 0
  // A vanilla agent has no radius of its own: its belief, if it is given one, is of the attack's.
  if (!spec.knows_eps()) spec.eps = match.eps;
  match.acting = deep::acting_of(spec, o.change);
  match.agent = deep::make_agent(*match.trained, match.acting);
  const std::shared_ptr<deep::ActionValueModule> values = match.trained->values_in_rewards();
  deep::AttackTarget target{values,
                            values,
                            deep::identity_of(*match.trained, match.acting),
                            [&] { return deep::make_agent(*match.trained, match.acting); },
                            spec.training.reward_scale,
                            match.acting.world};
  if (deep::attack_named(o.attack).knows == deep::Knowledge::defence) {
    const std::filesystem::path judge = judge_of(o, spec);
    if (!judge.empty()) target.judge = deep::read_agent(judge).values_in_rewards();
    match.judge = judge.empty() ? "the agent's own values" : judge.string();
  }
  deep::AttackSetting setting;
  setting.name = o.attack;
  setting.eps = match.eps;
  setting.seed = o.attack_seed.value_or(1);
  setting.quick = o.quick;
  setting.file = o.attacker;
  setting.progress = [&](double share, double) {
    if (o.progress) o.progress(fmt::format("{} learns, {:.0f} %", o.attack, 100 * share));
    return true;
  };
  match.attack = deep::make_attack(setting, target);
  return match;
}

}  // namespace maximin::apps
