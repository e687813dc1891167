#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <maximin/deep/attacks/named_attack.hpp>
#include <maximin/deep/lattice_agent.hpp>
#include <maximin/deep/lattice_world.hpp>
#include <maximin/deep/lattice_worst_case.hpp>
#include <maximin/deep/runtime.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/tabular/belief_control.hpp>
#include <maximin/tabular/finite_horizon.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/error.hpp>

/// How far attacks on trained agents are from the exact optimal attacker, and agents from what can be guaranteed: both
/// on the lattice, where it can be said exactly.
///
///     deep_ceiling [OPTION...] [AGENT_FILE...]        --help tells the options
///
/// An agent whose belief is a particle filter is taken with the exact belief of the lattice. Agents were trained in the
/// continuous world; on a coarse lattice diagonal moves end elsewhere (bench/gridworld_discretisation), so look at "no
/// attack" first: what is lost there is no attacker's doing.
namespace maximin::deep {
namespace {

struct Settings {
  int steps = 1;
  GridworldLatticeOptions lattice;
  bool interpolated = false, without_attacks = false;
  ActingChange change;
  long positions = 2'000'000, beliefs = 2'000'000, rounds = 4;
  std::string learned = "no";
  std::vector<std::filesystem::path> files;
};

void declare(CLI::App& app, Settings& s) {
  app.add_option("FILE", s.files, "Agent files");
  app.add_option("--steps", s.steps, "Lattice steps to a move: spacing 0.5/steps")->check(CLI::Range(1, 100));
  app.add_option("--eps", s.lattice.eps, "Radius of the balls on the lattice")->check(CLI::Range(0.0, 5.0));
  app.add_flag("--interpolated", s.interpolated, "Diagonal moves random, right on average, not to the nearest point");
  app.add_option("--belief", s.change.belief, "In place of the agents' own: observed, ball or exact")
      ->check(CLI::IsMember({"observed", "ball", "exact"}));
  app.add_option("--aggregator", s.change.aggregator, "In place of the agents' own: min, mean, soft-min:B, cvar:A");
  app.add_option("--positions", s.positions, "(truth, belief) before an exact worst case is given up")
      ->check(CLI::PositiveNumber);
  app.add_option("--beliefs", s.beliefs, "Before what an agent can be sure of is given up; 0: not asked")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--rounds", s.rounds, "Episodes from every start for attacks that draw")->check(CLI::PositiveNumber);
  app.add_flag("--without-attacks", s.without_attacks, "The exact attacker alone");
  app.add_option("--learned", s.learned, "Learned attacks too, taught in the continuous world: no, quick or full")
      ->check(CLI::IsMember({"no", "quick", "full"}));
}

class Clock {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Over starts.
struct Line {
  double mean = 0, least = std::numeric_limits<double>::infinity();
};

Line over_starts(const LatticeWorld& world, const Values<double>& v) {
  Line line;
  for (const State s : world.starts()) {
    line.mean += v[s] / static_cast<double>(world.starts().size());
    line.least = std::min(line.least, v[s]);
  }
  return line;
}

void print(const std::string& what, const Line& total, const Line& discounted, const std::string& note) {
  fmt::print("  {:<34} total {:>8.2f} (worst start {:>8.2f})  discounted {:>8.2f} ({:>8.2f})  {}\n", what, total.mean,
             total.least, discounted.mean, discounted.least, note);
  std::fflush(stdout);
}

void report_world(const LatticeWorld& world, long max_beliefs) {
  const auto& o = world.options();
  fmt::print("lattice of spacing {:.4f}, {} states, eps {:.4f}, largest ball {}, diagonals {}\n", o.spacing,
             world.mdp().states(), o.eps, world.balls().largest_ball(),
             o.diagonal == DiagonalMove::nearest ? "nearest" : "interpolated");
  const auto clean = policy_iteration(world.mdp());
  print("optimal without attack", over_starts(world, optimal_in_steps(world.mdp(), 100).with_all_steps()),
        over_starts(world, clean.v), "");
  if (max_beliefs == 0) return;
  try {
    const Clock clock;
    const auto total = guaranteed_value(world.mdp(), world.balls(), {.steps = 100, .max_beliefs = max_beliefs});
    const auto sure = guaranteed_value(world.mdp(), world.balls(), {.max_beliefs = max_beliefs});
    print("an agent can be sure of", over_starts(world, total.v), over_starts(world, sure.v),
          fmt::format("{} beliefs, {:.1f} s", sure.beliefs, clock.seconds()));
  } catch (const BudgetExhausted& e) {
    fmt::print("  {}\n", e.what());
  }
}

LatticeMemory memory_of(const std::string& belief) {
  return belief == "observed" ? LatticeMemory::observed : belief == "ball" ? LatticeMemory::ball : LatticeMemory::exact;
}

void report_worst_case(const LatticeWorld& world, const LatticeMind& mind, long positions) {
  try {
    const Clock clock;
    const LatticeWorstCase total(world, mind, {.max_positions = positions});
    const LatticeWorstCase discounted(world, mind, {.steps = 0, .max_positions = positions});
    print("optimal attack", over_starts(world, total.v()), over_starts(world, discounted.v()),
          fmt::format("{} positions, {} beliefs, {:.1f} s", total.positions(), total.beliefs(), clock.seconds()));
  } catch (const BudgetExhausted& e) {
    fmt::print("  optimal attack: {}\n", e.what());
  }
}

void report_attack(const LatticeWorld& world, const LatticeMind& mind, GridAttack& attack, const std::string& title,
                   long rounds) {
  const Clock clock;
  LatticeAgent agent(world, mind);
  OnLattice on_lattice(attack, world);
  // Both are of the first 100 steps.
  const auto totals = play_every_start(world, agent, on_lattice, rounds, 1);
  const std::size_t n = world.starts().size();
  Values<double> total = Values<double>::Zero(world.mdp().states()), discounted = total;
  for (std::size_t k = 0; k < totals.size(); ++k) {
    const State s = world.starts()[k % n];
    total[s] += totals[k].total_reward / static_cast<double>(rounds);
    discounted[s] += totals[k].discounted_return / static_cast<double>(rounds);
  }
  print(title, over_starts(world, total), over_starts(world, discounted),
        fmt::format("discounted in 100 steps, {:.1f} s", clock.seconds()));
}

void report_agent(const LatticeWorld& world, const std::filesystem::path& file, const Settings& settings) {
  TrainedAgent trained = read_agent(file);
  // A vanilla agent has no radius of its own.
  if (!trained.spec.knows_eps()) trained.spec.eps = settings.lattice.eps;
  const Acting acting = acting_of(trained.spec, settings.change);
  const std::shared_ptr<ActionValueModule> values = trained.values();
  const LatticeMind mind = deep_mind(values_on_lattice(*values, world), aggregator_named(acting.aggregator),
                                     memory_of(acting.belief), world);
  fmt::print("{}: belief {}{}, {}{}\n", file.filename().string(), acting.belief,
             acting.belief.starts_with("pf-") ? " (here: exact)" : "", acting.aggregator,
             acting.random_actions > 0 ? ", its random actions left out" : "");
  const std::shared_ptr<ActionValueModule> in_rewards = trained.values_in_rewards();
  const AttackTarget target{in_rewards, in_rewards, "", [&] { return make_agent(trained, acting); },
                            trained.spec.training.reward_scale};
  for (const NamedAttack& named : named_attacks()) {
    if (named.learned ? settings.learned == "no" : settings.without_attacks && named.name != "none") continue;
    if (named.name == "through-defence") continue;  // differentiates what the agent goes by, off the lattice
    AttackSetting setting;
    setting.name = named.name;
    setting.eps = world.options().eps;
    setting.quick = settings.learned == "quick";
    const auto attack = make_attack(setting, target);
    report_attack(world, mind, *attack, named.title, named.name == "none" ? 1 : settings.rounds);
  }
  report_worst_case(world, mind, settings.positions);
}

}  // namespace
}  // namespace maximin::deep

int main(int argc, char** argv) {
  using namespace maximin::deep;
  prepare_runtime();
  CLI::App app("What trained agents are worth on the lattice against the exact optimal attacker.", "deep_ceiling");
  Settings settings;
  declare(app, settings);
  try {
    app.parse(argc, argv);
    settings.lattice.spacing = 0.5 / settings.steps;
    settings.lattice.diagonal =
        settings.interpolated ? maximin::DiagonalMove::interpolated : maximin::DiagonalMove::nearest;
    const LatticeWorld world(settings.lattice);
    report_world(world, settings.beliefs);
    for (const auto& file : settings.files) report_agent(world, file, settings);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const maximin::InputError& e) {
    fmt::print(stderr, "deep_ceiling: {}\n", e.what());
    return 2;
  }
}
