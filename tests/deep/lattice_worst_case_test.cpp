#include <maximin/deep/lattice_worst_case.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <torch/torch.h>

#include <maximin/deep/attacks/adaptive_director.hpp>
#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/network_search.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/pa_ad_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/lattice_agent.hpp>
#include <maximin/deep/lattice_world.hpp>
#include <maximin/tabular/belief_control.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/error.hpp>

/// The exact optimal attacker as the ceiling of the deep layer's attacks, on the lattice.
namespace maximin::deep {
namespace {

/// Totals of 100 whole rewards are whole numbers: what is played is the value to the last bit, up to the rounding that
/// the value certifies. Discounted returns of deterministic episodes: that, and what comes after 2000 steps.
constexpr double total_tolerance = 1e-9;
constexpr double discounted_tolerance = 1e-5;
constexpr long for_ever = 2000;

/// A table of the lattice that can be differentiated: values at a place are means over lattice points, weighted by a
/// narrow bell; at a lattice point they are the table's own, up to 1e-5 of the differences.
class SmoothTable final : public ActionValueModule {
 public:
  SmoothTable(const QTable<double>& q, const LatticeWorld& world) {
    torch::Tensor table = torch::empty({q.rows(), q.cols()}), places = torch::empty({q.rows(), 2});
    for (State s = 0; s < q.rows(); ++s) {
      for (Action a = 0; a < q.cols(); ++a) table[s][a] = q(s, a);
      places[s][0] = world.place(s).x;
      places[s][1] = world.place(s).y;
    }
    table_ = register_parameter("table", table, false);
    places_ = register_buffer("places", places);
  }
  torch::Tensor forward(const torch::Tensor& states) override {
    // |x - p|^2 without |x|^2, which is the same for all p.
    return torch::softmax(100 * states.matmul(places_.t()) - 50 * places_.square().sum(1), 1).matmul(table_);
  }

 private:
  torch::Tensor table_, places_;
};

struct Attacker {
  std::string name;
  std::shared_ptr<GridAttack> attack;
  long rounds;  ///< from each start: several of what draws
};

/// All kinds but the descent through the defence, which asks for an agent of networks. What a director is taught
/// changes which of the same places it shows, and no director can show others.
std::vector<Attacker> deep_attacks(const std::shared_ptr<ActionValueModule>& q,
                                   const std::shared_ptr<ActionValueModule>& judge, const ObservationBall& ball) {
  const auto gradient = [&](AttackObjective objective) {
    GradientAttackOptions options;
    options.objective = objective;
    options.steps = 5;
    options.step_share = 0.2;
    return std::make_shared<GradientAttack>(q, ball, options);
  };
  const auto search = [&](AttackObjective objective) {
    return std::make_shared<NetworkSearch>(q, ball, NetworkSearchOptions{objective, 3, 0});
  };
  const auto director = [&](Director::Play play) {
    AdaptiveDirectorOptions options;
    options.grid = 3;
    auto untaught = std::make_shared<AdaptiveDirector>(judge, ball, options);
    untaught->set_play(play);
    return untaught;
  };
  return {
      {"none", std::make_shared<NoAttack>(), 1},
      {"random", std::make_shared<RandomAttack>(ball), 2},
      {"constant offset", std::make_shared<ConstantOffsetAttack>(ball), 2},
      {"PGD", gradient(AttackObjective::value), 1},
      {"PGD, cross-entropy", gradient(AttackObjective::cross_entropy), 1},
      {"MinBest", gradient(AttackObjective::min_best), 1},
      {"PGD's objective by search", search(AttackObjective::value), 1},
      {"MinBest's objective by search", search(AttackObjective::min_best), 1},
      {"PA-AD, untaught", std::make_shared<PaAdAttack>(q, ball), 1},
      {"director, untaught", director(Director::Play::sampled), 1},
      {"director, untaught and greedy", director(Director::Play::greedy), 1},
      {"best response, everywhere", std::make_shared<BestResponseAttack>(judge, ball, BestResponseOptions{3, 0}), 1},
      {"best response", std::make_shared<BestResponseAttack>(judge, ball, BestResponseOptions{}), 1},
      {"best response, steady", std::make_shared<BestResponseAttack>(judge, ball, BestResponseOptions{3, 0, true}), 1}};
}

/// Returns, by start: the least over all rounds. Totals, or discounted.
std::vector<double> least_returns(const LatticeWorld& world, const LatticeMind& mind, GridAttack& attack, long rounds,
                                  bool discounted) {
  LatticeAgent agent(world, mind);
  const long horizon = discounted ? for_ever : ContinuousGridworld::horizon;
  const auto episodes = play_every_start(world, agent, attack, rounds, 7, horizon);
  const std::size_t n = world.starts().size();
  std::vector<double> least(n, INFINITY);
  for (std::size_t k = 0; k < episodes.size(); ++k) {
    const double value = discounted ? episodes[k].discounted_return : episodes[k].total_reward;
    least[k % n] = std::min(least[k % n], value);
  }
  return least;
}

/// In how many starts the attack left less than the ceiling says is possible; the lattice is deterministic, so that is
/// asked of every single episode.
int below(const LatticeWorld& world, const std::vector<double>& returns, const Values<double>& v, double tolerance) {
  int count = 0;
  for (std::size_t k = 0; k < returns.size(); ++k) count += returns[k] < v[world.starts()[k]] - tolerance;
  return count;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double largest_difference(const LatticeWorld& world, const std::vector<double>& returns, const Values<double>& v) {
  double most = 0;
  for (std::size_t k = 0; k < returns.size(); ++k) {
    most = std::max(most, std::abs(returns[k] - v[world.starts()[k]]));
  }
  return most;
}

/// One defence: what an agent acts by and what attacks know of it.
struct Defence {
  std::string name;
  LatticeMind mind;
  std::shared_ptr<ActionValueModule> attacked, judge;
};

class LatticeWorstCaseTest : public ::testing::Test {
 protected:
  LatticeWorstCaseTest() {
    clean_ = policy_iteration(world_.mdp()).q;
    table_ = std::make_shared<SmoothTable>(clean_, world_);
    Stream rng(5);
    network_ = std::make_shared<QNetwork>(QNetworkShape{.hidden = {64, 64}, .waves = 1}, rng);
  }

  /// A small network that has learned the clean table for a second or two.
  void train_network() {
    torch::optim::Adam adam(network_->parameters(), torch::optim::AdamOptions(3e-3));
    std::vector<Point> places;
    for (State s = 0; s < world_.mdp().states(); ++s) places.push_back(world_.place(s));
    torch::Tensor states = torch::empty({world_.mdp().states(), 2});
    for (State s = 0; s < world_.mdp().states(); ++s) {
      states[s][0] = places[static_cast<std::size_t>(s)].x;
      states[s][1] = places[static_cast<std::size_t>(s)].y;
    }
    const torch::Tensor target = table_->forward(states) / 100;
    for (int i = 0; i < 600; ++i) {
      adam.zero_grad();
      torch::mse_loss(network_->forward(states), target).backward();
      adam.step();
    }
  }

  std::vector<Defence> defences() {
    const QTable<double> learned = values_on_lattice(*network_, world_);
    const auto of = [&](const QTable<double>& q, const AnyAggregator& aggregator, LatticeMemory memory) {
      return deep_mind(q, aggregator, memory, world_);
    };
    return {{"Q*, observed", of(clean_, MinAggregator{}, LatticeMemory::observed), table_, table_},
            {"Q*, ball, mean", of(clean_, MeanAggregator{}, LatticeMemory::ball), table_, table_},
            {"Q*, exact, min", of(clean_, MinAggregator{}, LatticeMemory::exact), table_, table_},
            {"Q*, exact, mean", of(clean_, MeanAggregator{}, LatticeMemory::exact), table_, table_},
            {"network, observed", of(learned, MinAggregator{}, LatticeMemory::observed), network_, table_},
            {"network, exact, mean", of(learned, MeanAggregator{}, LatticeMemory::exact), network_, table_},
            {"network, exact, cvar", of(learned, CvarAggregator(0.5), LatticeMemory::exact), network_, table_}};
  }

  const LatticeWorld world_;
  const ObservationBall ball_{world_.options().eps};
  QTable<double> clean_;
  std::shared_ptr<SmoothTable> table_;
  QNetworkPtr network_;
};

/// The criterion: no attack of the deep layer is stronger than the exact optimal attacker, from any start.
TEST_F(LatticeWorstCaseTest, NoDeepAttackIsStrongerThanTheOptimalOneWhichAttainsItsValue) {
  train_network();
  double strongest_gap = INFINITY;
  for (const Defence& defence : defences()) {
    SCOPED_TRACE(defence.name);
    const LatticeWorstCase total(world_, defence.mind, {.keep = true});
    OptimalLatticeAttack optimal(total, world_);
    const auto attained = least_returns(world_, defence.mind, optimal, 1, false);
    EXPECT_LE(largest_difference(world_, attained, total.v()), total_tolerance);
    for (const Attacker& a : deep_attacks(defence.attacked, defence.judge, ball_)) {
      OnLattice on_lattice(*a.attack, world_);
      const auto returns = least_returns(world_, defence.mind, on_lattice, a.rounds, false);
      EXPECT_EQ(below(world_, returns, total.v(), total_tolerance), 0) << a.name;
      if (a.name != "none") strongest_gap = std::min(strongest_gap, mean(returns) - total.mean());
    }
  }
  EXPECT_LT(strongest_gap, 20) << "the comparison is empty if all of them are far weaker";
}

TEST_F(LatticeWorstCaseTest, DiscountedForEverToo) {
  for (const auto memory : {LatticeMemory::observed, LatticeMemory::exact}) {
    const LatticeMind mind = deep_mind(clean_, MeanAggregator{}, memory, world_);
    const LatticeWorstCase worst(world_, mind, {.steps = 0, .keep = true});
    OptimalLatticeAttack optimal(worst, world_);
    EXPECT_LE(largest_difference(world_, least_returns(world_, mind, optimal, 1, true), worst.v()),
              discounted_tolerance);
    BestResponseAttack best_response(table_, ball_, BestResponseOptions{3, 0});
    OnLattice on_lattice(best_response, world_);
    const auto returns = least_returns(world_, mind, on_lattice, 1, true);
    EXPECT_EQ(below(world_, returns, worst.v(), discounted_tolerance), 0);
  }
}

/// Negative controls: what the comparisons above would find.
TEST_F(LatticeWorstCaseTest, CheatsAndWrongValuesAreFound) {
  const LatticeMind mind = deep_mind(clean_, MinAggregator{}, LatticeMemory::observed, world_);
  const LatticeWorstCase right(world_, mind, {.keep = true});
  OptimalLatticeAttack optimal(right, world_);
  const auto attained = least_returns(world_, mind, optimal, 1, false);

  // A value that is wrong in one start.
  Values<double> wrong = right.v();
  wrong[world_.starts()[17]] += 1;
  EXPECT_EQ(below(world_, attained, wrong, total_tolerance), 1);
  EXPECT_GE(largest_difference(world_, attained, wrong), 1 - total_tolerance);

  // The value of one step less, or against smaller balls, or of another agent, is not attained.
  const LatticeWorstCase shorter(world_, mind, {.steps = 99});
  EXPECT_GT(largest_difference(world_, attained, shorter.v()), 0.5);
  const LatticeWorstCase other(world_, deep_mind(clean_, MeanAggregator{}, LatticeMemory::exact, world_));
  EXPECT_GT(below(world_, attained, other.v(), total_tolerance), 100);

  // An attack that shows what lies a lattice step further out: the rules stop it, and, let through, it is too strong.
  const LatticeWorld larger({.eps = 1.0});
  const LatticeWorstCase cheating(larger, mind, {.keep = true});
  OptimalLatticeAttack cheat(cheating, larger);
  EXPECT_THROW(least_returns(world_, mind, cheat, 1, false), std::logic_error);
  const auto too_low = least_returns(larger, mind, cheat, 1, false);
  EXPECT_GT(below(world_, too_low, right.v(), total_tolerance), 10);
}

TEST_F(LatticeWorstCaseTest, TheAgentOnTheLatticeDecidesAsTheDeepOne) {
  const QTable<double> q = values_on_lattice(*table_, world_) / 100;
  torch::Tensor rows = torch::empty({q.rows(), q.cols()});
  for (State s = 0; s < q.rows(); ++s) {
    for (Action a = 0; a < q.cols(); ++a) rows[s][a] = q(s, a);
  }
  Stream rng(3);
  for (const std::string name : {"min", "mean", "soft-min:2", "cvar:0.3"}) {
    const AnyAggregator aggregator = aggregator_named(name);
    const LatticeMind mind = deep_mind(q, aggregator, LatticeMemory::exact, world_);
    int differ = 0;
    for (int i = 0; i < 200; ++i) {
      Belief belief;
      for (const State s : world_.starts()) {
        if (rng.chance(0.03)) belief.push_back(s);
      }
      if (belief.empty()) continue;
      const std::vector<long> members(belief.begin(), belief.end());
      const torch::Tensor states = rows.index_select(0, torch::tensor(members)).unsqueeze(0);
      const auto n = static_cast<double>(belief.size());
      const torch::Tensor values = aggregate(aggregator, states, torch::full({1, states.size(1)}, 1 / n))[0];
      const double lost = values.max().item<double>() - values[mind.policy(belief)].item<double>();
      EXPECT_LE(lost, 1e-5) << name;
      const LatticeMind most = deep_mind(q, MinAggregator{}, LatticeMemory::exact, world_);
      differ += values.max().item<double>() - values[most.policy(belief)].item<double>() > 1e-5;
    }
    EXPECT_EQ(differ > 0, name != "min") << name;
  }
}

TEST_F(LatticeWorstCaseTest, RefusesWhatItCannotAnswer) {
  const LatticeMind mind = deep_mind(clean_, MeanAggregator{}, LatticeMemory::exact, world_);
  EXPECT_THROW(LatticeWorstCase(world_, mind, {.max_positions = 100}), BudgetExhausted);
  const LatticeWorstCase bare(world_, mind);
  EXPECT_THROW(OptimalLatticeAttack(bare, world_), std::logic_error);
  EXPECT_THROW(bare.after(0, 0, {0}, 1), std::logic_error);
  EXPECT_THROW(world_.state({0.3, 0.25}), std::invalid_argument);
  EXPECT_THROW(world_.state({1.25, 0.25}), std::invalid_argument) << "a wall";
  EXPECT_THROW(world_.state({-0.25, 0.25}), std::invalid_argument);
  for (State s = 0; s < world_.mdp().states(); ++s) EXPECT_EQ(world_.state(world_.place(s)), s);
  EXPECT_EQ(world_.starts().size(), 264U);
}

}  // namespace
}  // namespace maximin::deep
