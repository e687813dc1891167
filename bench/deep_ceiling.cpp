#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
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
///     deep_ceiling [name=value...] AGENT_FILE...
///
///     steps=1           lattice steps to a move: spacing 0.5/steps
///     eps=0.5           radius of the balls on the lattice
///     diagonal=nearest  or interpolated (random, right on average)
///     belief=, aggregator=   in the place of the agents' own: observed, ball or exact; min, mean, soft-min:B, cvar:A
///     positions=2000000      of (truth, belief), before the exact worst case of an agent with memory is given up
///     beliefs=2000000        before what an agent can be sure of is given up; 0: not asked
///     rounds=4               episodes from every start for attacks that draw
///     attacks=yes            the deep layer's attacks too, but for those that ask the agent for more than its answers
///     learned=no             or quick, or full: learned attacks too, taught in the continuous world, for seconds or
///                            minutes
///
/// An agent whose belief is a particle filter is taken with the exact belief of the lattice. Agents were trained in the
/// continuous world; on a coarse lattice diagonal moves end elsewhere (bench/gridworld_discretisation), so look at "no
/// attack" first: what is lost there is no attacker's doing.
namespace maximin::deep {
namespace {

struct Settings {
  GridworldLatticeOptions lattice;
  std::string belief, aggregator;
  long positions = 2'000'000, beliefs = 2'000'000, rounds = 4;
  bool attacks = true;
  std::string learned = "no";
  std::vector<std::filesystem::path> files;
};

Settings parse(int argc, char** argv) {
  Settings s;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (equals == std::string::npos) {
      s.files.emplace_back(text);
    } else if (name == "steps") {
      s.lattice.spacing = 0.5 / std::atoi(value.c_str());
    } else if (name == "eps") {
      s.lattice.eps = std::atof(value.c_str());
    } else if (name == "diagonal") {
      s.lattice.diagonal = value == "interpolated" ? DiagonalMove::interpolated : DiagonalMove::nearest;
    } else if (name == "belief") {
      s.belief = value;
    } else if (name == "aggregator") {
      s.aggregator = value;
    } else if (name == "positions") {
      s.positions = std::atol(value.c_str());
    } else if (name == "beliefs") {
      s.beliefs = std::atol(value.c_str());
    } else if (name == "rounds") {
      s.rounds = std::atol(value.c_str());
    } else if (name == "attacks") {
      s.attacks = value == "yes";
    } else if (name == "learned") {
      s.learned = value;
    } else {
      throw InputError(fmt::format(
          "{}: expected steps, eps, diagonal, belief, aggregator, positions, beliefs, rounds, attacks or learned",
          text));
    }
  }
  return s;
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
  // What comes after 1000 steps is discounted to nothing; the total is that of the first 100.
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
  const TrainedAgent trained = read_agent(file);
  Acting acting = acting_of(trained.spec);
  if (!settings.belief.empty()) acting.belief = settings.belief;
  if (!settings.aggregator.empty()) acting.aggregator = settings.aggregator;
  const std::shared_ptr<ActionValueModule> values = trained.values();
  const LatticeMind mind = deep_mind(values_on_lattice(*values, world), aggregator_named(acting.aggregator),
                                     memory_of(acting.belief), world);
  fmt::print("{}: belief {}{}, {}{}\n", file.filename().string(), acting.belief,
             acting.belief.starts_with("pf-") ? " (here: exact)" : "", acting.aggregator,
             acting.random_actions > 0 ? ", its random actions left out" : "");
  const std::shared_ptr<ActionValueModule> in_rewards = trained.values_in_rewards();
  const AttackTarget target{in_rewards, in_rewards, "", trained.spec.training.reward_scale,
                            [&] { return make_agent(trained, acting); }};
  for (const NamedAttack& named : named_attacks()) {
    if (named.learned ? settings.learned == "no" : !settings.attacks && named.name != "none") continue;
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
  try {
    const Settings settings = parse(argc, argv);
    const LatticeWorld world(settings.lattice);
    report_world(world, settings.beliefs);
    for (const auto& file : settings.files) report_agent(world, file, settings);
  } catch (const maximin::InputError& e) {
    fmt::print(stderr, "deep_ceiling: {}\n", e.what());
    return 2;
  }
}
