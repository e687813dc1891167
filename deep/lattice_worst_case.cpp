#include <maximin/deep/lattice_worst_case.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/theory/rollout_in_step.hpp>

namespace maximin::deep {

LatticeWorstCase::LatticeWorstCase(const LatticeWorld& world, const LatticeMind& mind, const WorstCaseOptions& options)
    : world_(&world), options_(options) {
  if (mind.memory == LatticeMemory::exact) {
    solve_with_belief(mind);
  } else {
    solve_without_memory(mind);
  }
  if (!options.keep) {
    value_.clear();
    numbers_.clear();
  }
}

void LatticeWorstCase::solve_without_memory(const LatticeMind& mind) {
  const FiniteMdp<double>& mdp = world_->mdp();
  for (State t = 0; t < mdp.states(); ++t) {
    stationary_.push_back(mind.memory == LatticeMemory::observed ? mind.policy(std::span(&t, 1))
                                                                 : mind.policy(world_->balls().ball(t)));
  }
  positions_ = beliefs_ = mdp.states();
  if (options_.steps == 0) {
    auto solved = evaluate_against_optimal_attack(mdp, world_->balls(), stationary_);
    error_ = solved.error;
    value_.push_back(std::move(solved.v));
  } else {
    auto solved = attacked_in_steps(mdp, world_->balls(), stationary_, options_.steps);
    error_ = solved.error;
    value_ = std::move(solved.v);
  }
  v_ = value_.back();
}

void LatticeWorstCase::solve_with_belief(const LatticeMind& mind) {
  const BeliefGameOptions options{.max_positions = options_.max_positions, .keep_positions = options_.keep};
  const auto take = [&](auto& game) {
    v_ = game.v;
    error_ = game.error;
    positions_ = game.positions;
    beliefs_ = game.beliefs;
  };
  if (options_.steps != 0) {
    auto game = solve_belief_game_in_steps(world_->mdp(), world_->balls(), mind.policy, options_.steps, options);
    take(game);
    numbers_ = std::move(game.numbers);
    value_ = std::move(game.w);
    return;
  }
  const auto game = solve_belief_game(world_->mdp(), world_->balls(), mind.policy, options);
  take(game);
  value_.emplace_back(static_cast<Eigen::Index>(game.w.size()));
  for (const auto& [position, value] : game.w) {
    const auto number = static_cast<int>(numbers_.size());
    value_.front()[number] = value;
    numbers_.emplace(position, number);
  }
}

double LatticeWorstCase::mean() const {
  double sum = 0;
  for (const State s : world_->starts()) sum += v_[s];
  return sum / static_cast<double>(world_->starts().size());
}

double LatticeWorstCase::least() const {
  double least = std::numeric_limits<double>::infinity();
  for (const State s : world_->starts()) least = std::min(least, v_[s]);
  return least;
}

double LatticeWorstCase::after(State truth, State shown, const Belief& belief, long left) const {
  if (!options_.keep) throw std::logic_error("worst case: solved without keep");
  const bool for_ever = options_.steps == 0;
  const auto at = static_cast<std::size_t>(for_ever ? 0 : left);
  if (stationary_.empty()) return value_.at(at)[numbers_.at({truth, belief})];
  const FiniteMdp<double>& mdp = world_->mdp();
  const Action a = stationary_.at(static_cast<std::size_t>(shown));
  const double discount = for_ever ? mdp.discount() : 1;
  return mdp.reward(truth, a) + discount * mdp.expectation(truth, a, value_.at(for_ever ? 0 : at - 1));
}

OptimalLatticeAttack::OptimalLatticeAttack(const LatticeWorstCase& solution, const LatticeWorld& world)
    : solution_(&solution), world_(&world) {
  if (!solution.options().keep) throw std::logic_error("optimal attack: solved without keep");
}

void OptimalLatticeAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                   std::span<Stream>, std::span<Point> shown) {
  const auto* on_lattice = dynamic_cast<const LatticeAgent*>(&agent);
  if (!on_lattice) throw std::invalid_argument("optimal attack: expected an agent of the lattice");
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const long left = solution_->options().steps - taken_[static_cast<std::size_t>(lanes[k])]++;
    const State truth = world_->state(truths[k]);
    double least = std::numeric_limits<double>::infinity();
    for (const State t : world_->balls().ball(truth)) {
      const double value = solution_->after(truth, t, on_lattice->would_believe(lanes[k], t), left);
      if (value >= least) continue;
      least = value;
      shown[k] = world_->place(t);
    }
  }
}

std::vector<Episode> play_every_start(const LatticeWorld& world, GridAgent& agent, GridAttack& attack, long rounds,
                                      std::uint64_t seed, long horizon) {
  EveryStart every(world);
  WithinLatticeBall bounded(attack, world);
  EpisodesInStep options;
  options.discount = world.mdp().discount();
  options.horizon = horizon;
  options.episodes = rounds * static_cast<long>(world.starts().size());
  options.seed = seed;
  options.lanes = 256;  // a lattice has hundreds of starts, and most of an attack's time is spent per call
  return rollout_in_step(every, agent, bounded, options);
}

}  // namespace maximin::deep
