#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <queue>
#include <set>
#include <string>
#include <vector>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/models/builtin_models.hpp>
#include <maximin/models/chain.hpp>
#include <maximin/models/garnet.hpp>
#include <maximin/models/grid_world.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

template <class Make>
std::string error_of(Make make) {
  try {
    make();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

State state_named(const Model<double>& m, const std::string& name) {
  const auto found = std::find(m.state_names.begin(), m.state_names.end(), name);
  EXPECT_NE(found, m.state_names.end()) << name;
  return static_cast<State>(found - m.state_names.begin());
}

State only_successor(const FiniteMdp<double>& mdp, State s, Action a) {
  EXPECT_EQ(mdp.successors(s, a).size(), 1u);
  return mdp.successors(s, a).front().target;
}

RC_GTEST_PROP(Garnet, HasItsBranchingAndRewards, ()) {
  const State n = *rc::gen::inRange(1, 30);
  const State branching = *rc::gen::inRange(1, n + 1);
  const Action actions = *rc::gen::inRange(1, 4);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Stream rng(seed), same(seed);
  const auto model = garnet(n, actions, branching, 0.9, rng);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      RC_ASSERT(model.mdp.successors(s, a).size() == static_cast<std::size_t>(branching));
      RC_ASSERT(model.mdp.reward(s, a) >= 0 && model.mdp.reward(s, a) < 1);
    }
  }
  RC_ASSERT(model.mdp == garnet(n, actions, branching, 0.9, same).mdp);
  RC_ASSERT(make_perturbation(model).states() == n);
}

TEST(Garnet, RejectsWhatItCannotBe) {
  Stream rng(1);
  EXPECT_EQ(error_of([&] { garnet(3, 1, 4, 0.9, rng); }), "branching: 4, expected 1 to the number of states");
  EXPECT_EQ(error_of([&] { garnet(0, 1, 1, 0.9, rng); }), "states: 0, expected 1 to 1000000");
  EXPECT_EQ(error_of([&] { garnet(3, 0, 1, 0.9, rng); }), "actions: 0, expected 1 to 1000");
}

/// Strens' chain: with gamma = 0.9 and no slip, going forward for ever from the last state is worth 10/(1-gamma).
TEST(Chain, ValuesByHand) {
  const auto sure = chain(5, 0.9, 0);
  const auto v = value_iteration(sure.mdp).v;
  for (State s = 0; s < 5; ++s) EXPECT_NEAR(v[s], 100 * std::pow(0.9, 4 - s), 1e-9);
  const auto slippery = chain(5, 0.9);
  EXPECT_NEAR(slippery.mdp.reward(0, 0), 0.4, 1e-15);
  EXPECT_NEAR(slippery.mdp.reward(4, 0), 8.4, 1e-15);
  EXPECT_EQ(slippery.mdp.successors(2, 1)[0], (Successor<double>{0, 0.8}));
  EXPECT_EQ(chain(1, 0.5).mdp.successors(0, 0)[0], (Successor<double>{0, 1.0}));
  EXPECT_EQ(make_perturbation(slippery).ball(2).size(), 3u);
  EXPECT_EQ(error_of([] { chain(0, 0.5); }), "states: 0, expected 1 to 1000000");
  EXPECT_EQ(error_of([] { chain(2, 0.5, 1.5); }), "slip: 1.5, expected 0 to 1");
}

TEST(GridWorld, MovesAsItsMapSays) {
  const auto m = grid_world({".#G", "S.T"});
  ASSERT_EQ(m.mdp.states(), 5);
  const State start = state_named(m, "cell-0-0"), corner = state_named(m, "cell-0-1"),
              hall = state_named(m, "cell-1-0");
  const State goal = state_named(m, "goal-2-1"), trap = state_named(m, "trap-2-0");
  enum : Action { north, east, south, west };
  EXPECT_EQ(only_successor(m.mdp, start, north), corner);
  EXPECT_EQ(only_successor(m.mdp, corner, east), corner) << "a wall stops it";
  EXPECT_EQ(only_successor(m.mdp, start, south), start) << "so does the edge";
  EXPECT_EQ(only_successor(m.mdp, hall, east), trap);
  EXPECT_EQ(m.mdp.reward(hall, east), -10);
  EXPECT_EQ(m.mdp.reward(hall, north), -1);
  for (Action a = 0; a < 4; ++a) {
    for (const State end : {goal, trap}) {
      EXPECT_EQ(only_successor(m.mdp, end, a), end);
      EXPECT_EQ(m.mdp.reward(end, a), 0);
    }
  }
  EXPECT_EQ(m.start[static_cast<std::size_t>(start)], 1);
  EXPECT_EQ(m.geometry.points(corner, 1), 1);
  EXPECT_EQ(make_perturbation(m).ball(start).size(), 3u);
}

TEST(GridWorld, SlipsToTheSides) {
  GridWorldOptions o;
  o.slip = 0.2;
  const auto m = grid_world({"..", "S.", "G."}, o);
  const State s = state_named(m, "cell-0-1");
  const auto row = m.mdp.successors(s, 0);  // north: 0.8 up, 0.1 into the left edge, 0.1 right
  ASSERT_EQ(row.size(), 3u);
  EXPECT_EQ(row[0], (Successor<double>{state_named(m, "cell-0-2"), 0.8}));
  EXPECT_EQ(row[1], (Successor<double>{s, 0.1}));
  EXPECT_NEAR(m.mdp.reward(s, 2), 0.8 * 10 - 0.2, 1e-12);
}

/// Without slip and traps, V* is a matter of counting steps.
RC_GTEST_PROP(GridWorld, OpenGridsAreWorthTheirDistance, ()) {
  const int width = *rc::gen::inRange(1, 7), height = *rc::gen::inRange(2, 7);
  std::vector<std::string> map(static_cast<std::size_t>(height), std::string(static_cast<std::size_t>(width), '.'));
  map.front().back() = 'G';
  GridWorldOptions o;
  o.discount = 0.8;
  const auto m = grid_world(map, o);
  const auto v = value_iteration(m.mdp).v;
  for (State s = 0; s < m.mdp.states(); ++s) {
    const double steps = (width - 1 - m.geometry.points(s, 0)) + (height - 1 - m.geometry.points(s, 1));
    const double far = std::pow(0.8, steps - 1);
    const double expected = steps == 0 ? 0 : 10 * far - (1 - far) / (1 - 0.8);
    RC_ASSERT(std::abs(v[s] - expected) < 1e-9);
  }
}

TEST(GridWorld, OpenGridHasStartGoalAndTrapInItsCorners) {
  const auto m = grid_world(3, 2);
  EXPECT_EQ(m.start[static_cast<std::size_t>(state_named(m, "cell-0-0"))], 1);
  EXPECT_EQ(m.mdp.reward(state_named(m, "cell-1-1"), 1), 10);
  EXPECT_EQ(m.mdp.reward(state_named(m, "cell-1-0"), 1), -10);
  EXPECT_EQ(grid_world(1, 2).mdp.states(), 2);
}

TEST(GridWorld, RejectsBadMaps) {
  EXPECT_EQ(error_of([] { grid_world(std::vector<std::string>{}); }), "map: empty, expected at least one cell");
  EXPECT_EQ(error_of([] { grid_world({"..", "."}); }), "map[1]: 1 cells, expected 2 as in the first row");
  EXPECT_EQ(error_of([] { grid_world({".x"}); }), "map[0][1]: 'x', expected one of . # S G T");
  EXPECT_EQ(error_of([] { grid_world({"#G"}); }), "map: no plain cell, expected at least one of . S");
  EXPECT_EQ(error_of([] { grid_world(1, 1); }), "grid: 1 x 1, expected sides of 1 to 1000 and at least two cells");
  EXPECT_EQ(error_of([] { grid_world(2, 2, {.slip = 2}); }), "slip: 2, expected 0 to 1");
}

TEST(GridworldLattice, HasTheGeographyOfThePaper) {
  const auto m = gridworld_lattice();
  EXPECT_EQ(m.mdp.states(), 68 * 4);
  EXPECT_EQ(m.mdp.actions(), 8);
  double starts = 0;
  int gold = 0, bomb = 0;
  for (State s = 0; s < m.mdp.states(); ++s) {
    const double x = m.geometry.points(s, 0), y = m.geometry.points(s, 1);
    gold += m.state_name(s).starts_with("gold") && x > 9 && y > 4 && y < 5;
    bomb += m.state_name(s).starts_with("bomb") && x > 9 && y > 5 && y < 6;
    starts += m.start[static_cast<std::size_t>(s)] > 0;
  }
  EXPECT_EQ(gold, 4);
  EXPECT_EQ(bomb, 4);
  EXPECT_EQ(starts, 66 * 4);
  enum : Action { up, up_right, right, down_right, down };
  const State corner = state_named(m, "(0.25,0.25)");
  EXPECT_EQ(only_successor(m.mdp, corner, up), state_named(m, "(0.25,0.75)"));
  EXPECT_EQ(only_successor(m.mdp, corner, up_right), state_named(m, "(0.75,0.75)"));
  EXPECT_EQ(only_successor(m.mdp, corner, down), corner);
  EXPECT_EQ(only_successor(m.mdp, state_named(m, "(0.75,0.25)"), right), state_named(m, "(0.75,0.25)")) << "a wall";
  const State before_gold = state_named(m, "(8.75,4.25)");
  EXPECT_EQ(m.mdp.reward(before_gold, right), 200);
  EXPECT_EQ(m.mdp.reward(state_named(m, "(8.75,5.25)"), right), -50);
  EXPECT_EQ(m.mdp.reward(before_gold, up), -1);
  EXPECT_EQ(m.mdp.reward(only_successor(m.mdp, before_gold, right), up), 0);
  const auto balls = make_perturbation(m);
  EXPECT_EQ(balls.ball(state_named(m, "(5.25,5.25)")).size(), 9u) << "0.5 in the maximum norm";
}

/// V* from the number of moves to the gold, counted by breadth-first search around the bomb.
TEST(GridworldLattice, IsWorthTheShortestWayToTheGold) {
  const auto m = gridworld_lattice();
  const auto n = static_cast<std::size_t>(m.mdp.states());
  std::vector<std::vector<State>> into(n);
  std::vector<int> moves(n, -1);
  std::queue<State> queue;
  for (State s = 0; s < m.mdp.states(); ++s) {
    if (m.state_name(s).starts_with("gold")) {
      moves[static_cast<std::size_t>(s)] = 0;
      queue.push(s);
    }
    if (m.start[static_cast<std::size_t>(s)] == 0) continue;  // an end of the episode
    for (Action a = 0; a < 8; ++a) into[static_cast<std::size_t>(only_successor(m.mdp, s, a))].push_back(s);
  }
  for (; !queue.empty(); queue.pop()) {
    for (const State s : into[static_cast<std::size_t>(queue.front())]) {
      int& count = moves[static_cast<std::size_t>(s)];
      if (count >= 0) continue;
      count = moves[static_cast<std::size_t>(queue.front())] + 1;
      queue.push(s);
    }
  }
  const auto v = value_iteration(m.mdp).v;
  for (State s = 0; s < m.mdp.states(); ++s) {
    if (m.start[static_cast<std::size_t>(s)] == 0) continue;
    const int count = moves[static_cast<std::size_t>(s)];
    ASSERT_GT(count, 0) << "all free points are connected";
    const double far = std::pow(0.99, count - 1);
    EXPECT_NEAR(v[s], 200 * far - (1 - far) / (1 - 0.99), 1e-8);
  }
}

/// Every transition of a lattice against the continuous world's step from the same point: straight moves exactly,
/// diagonal ones to within `off` on each axis and, where they are interpolated clear of walls, exactly in the mean.
/// Says what is wrong; nothing if all is well.
std::string fault(const Model<double>& m, double off, bool interpolated) {
  const ContinuousGridworld world;
  for (State s = 0; s < m.mdp.states(); ++s) {
    if (m.start[static_cast<std::size_t>(s)] == 0) continue;
    const Point from{m.geometry.points(s, 0), m.geometry.points(s, 1)};
    for (Action a = 0; a < 8; ++a) {
      const auto o = world.step(from, a);
      const bool diagonal = a % 2 == 1;
      const auto row = m.mdp.successors(s, a);
      const bool stays = row.size() == 1 && row[0].target == s;
      if (!diagonal || interpolated) {
        if (m.mdp.reward(s, a) != o.reward) return "reward";
        if (stays != (o.next == from)) return "walls";
      }
      if (stays || m.mdp.reward(s, a) != o.reward) continue;
      double x = -o.next.x, y = -o.next.y, sum = 0;
      for (const auto& next : row) {
        const double nx = m.geometry.points(next.target, 0), ny = m.geometry.points(next.target, 1);
        x += next.probability * nx;
        y += next.probability * ny;
        sum += next.probability;
        if (o.next != from && std::max(std::abs(nx - o.next.x), std::abs(ny - o.next.y)) > (diagonal ? off : 1e-9)) {
          return "place";
        }
      }
      if (std::abs(sum - 1) > 1e-12) return "probabilities";
      bool clear = interpolated;
      for (const double dx : {-off, off}) {
        for (const double dy : {-off, off}) {
          clear = clear && gridworld::cell({o.next.x + dx, o.next.y + dy}) == gridworld::cell(o.next);
        }
      }
      if (clear && std::hypot(x, y) > 1e-9) return "mean";
    }
  }
  return "";
}

TEST(GridworldLattice, FollowsTheContinuousWorldAtEverySpacing) {
  const double diagonal = gridworld::diagonal;
  for (const int k : {1, 2, 3, 5, 7}) {
    const double h = 0.5 / k, off = std::abs(std::round(diagonal / h) * h - diagonal) + 1e-9;
    const auto m = gridworld_lattice({.spacing = h});
    EXPECT_EQ(m.mdp.states(), 272 * k * k);
    EXPECT_EQ(m.mdp.transition_count(), static_cast<std::size_t>(8 * m.mdp.states()));
    EXPECT_EQ(fault(m, off, false), "") << h;
    EXPECT_EQ(fault(m, off / 2, false), "place") << "no nearer than the lattice allows";
    const auto mixed = gridworld_lattice({.spacing = h, .diagonal = DiagonalMove::interpolated});
    EXPECT_EQ(fault(mixed, h, true), "") << h;
    EXPECT_NE(fault(m, h, true), "") << "moves to the nearest point are not interpolated";
  }
}

TEST(GridworldLattice, RefusesSpacingsThatStraightMovesDoNotFit) {
  for (const double spacing : {0.0, -0.5, 1.0, 0.3, 0.2, 0.001, std::nan("")}) {
    EXPECT_NE(error_of([&] { gridworld_lattice({.spacing = spacing}); }).find("spacing: "), std::string::npos)
        << spacing;
  }
  EXPECT_EQ(error_of([] { gridworld_lattice({.spacing = 0.3}); }),
            "spacing: 0.3, expected 0.5 divided by a whole number from 1 to 50");
}

/// Finer lattices see smaller balls: of 0.1 only what is no coarser than that sees any.
TEST(GridworldLattice, BallsNeedALatticeAsFineAsTheyAre) {
  const auto size_at = [](double spacing) {
    const auto m = gridworld_lattice({.eps = 0.1, .spacing = spacing});
    const auto balls = make_perturbation(m);
    std::size_t largest = 0;
    for (State s = 0; s < m.mdp.states(); ++s) largest = std::max(largest, balls.ball(s).size());
    return largest;
  };
  EXPECT_EQ(size_at(0.5), 1u);
  EXPECT_EQ(size_at(0.125), 1u);
  EXPECT_EQ(size_at(0.1), 9u);
}

TEST(BuiltinModels, AreValidAndComplete) {
  const auto names = builtin_model_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    const auto m = builtin_model(name);
    EXPECT_FALSE(m.name.empty()) << name;
    EXPECT_FALSE(builtin_model_summary(name).empty()) << name;
    EXPECT_TRUE(m.geometry.eps.has_value()) << name;
    const auto balls = make_perturbation(m);
    EXPECT_GT(balls.largest_ball(), 1) << name;
    const auto of_size = [](const auto& list, int n) {
      return list.empty() || list.size() == static_cast<std::size_t>(n);
    };
    EXPECT_TRUE(of_size(m.state_names, m.mdp.states())) << name;
    EXPECT_TRUE(of_size(m.action_names, m.mdp.actions())) << name;
    EXPECT_TRUE(of_size(m.start, m.mdp.states())) << name;
    double start = m.start.empty() ? 1 : 0;
    for (const double p : m.start) start += p;
    EXPECT_NEAR(start, 1, 1e-12) << name;
  }
  EXPECT_EQ(error_of([] { builtin_model("nothing"); }),
            "example: 'nothing' is unknown, expected one of grid, russell-4x3, gridworld, tiger, chain, one-sided, "
            "cycling, garnet, lipschitz");
}

TEST(BuiltinModels, OneSidedLosesTenOfABoundOfSix) {
  const auto m = builtin_model("one-sided");
  const auto balls = make_perturbation(m);
  const auto run = pessimistic_q_iteration(m.mdp, balls);
  ASSERT_EQ(run.fate, Fate::settled);
  const auto optimal = value_iteration(m.mdp).q;
  EXPECT_NEAR((optimal - run.q).cwiseAbs().maxCoeff(), 10, 1e-9);
  EXPECT_EQ(model_constants(m.mdp, balls.metric()).l_r.value, 1);
}

TEST(BuiltinModels, CyclingHasPeriodThree) {
  const auto m = builtin_model("cycling");
  const auto run = pessimistic_q_iteration(m.mdp, make_perturbation(m));
  EXPECT_EQ(run.fate, Fate::cycles);
  EXPECT_EQ(run.period, 3);
}

/// With the tiger in sight the right door pays 10 for ever; who may be shown the wrong door listens.
TEST(BuiltinModels, TigerInSight) {
  const auto m = builtin_model("tiger");
  const auto solution = value_iteration(m.mdp);
  EXPECT_NEAR(solution.v[0], 10 / (1 - 0.95), 1e-8);
  EXPECT_EQ(m.action_name(solution.policy[0]), "open-right");
  EXPECT_EQ(m.action_name(solution.policy[1]), "open-left");
  const auto balls = make_perturbation(m);
  Policy careful;
  std::vector<double> scratch;
  maximin_policy(solution.q, balls, careful, scratch);
  EXPECT_EQ(m.action_name(careful[0]), "listen");
}

/// The policy that Russell and Norvig draw for a slightly unpleasant floor: around the wall by the left, up and right.
TEST(BuiltinModels, RussellsPolicy) {
  const auto m = builtin_model("russell-4x3");
  ASSERT_EQ(m.mdp.states(), 11);
  const auto solution = value_iteration(m.mdp);
  for (const char* name : {"cell-0-2", "cell-1-2", "cell-2-2"}) {
    EXPECT_EQ(m.action_name(solution.policy[static_cast<std::size_t>(state_named(m, name))]), "east") << name;
  }
  for (const char* name : {"cell-0-0", "cell-0-1", "cell-2-1"}) {
    EXPECT_EQ(m.action_name(solution.policy[static_cast<std::size_t>(state_named(m, name))]), "north") << name;
  }
}

}  // namespace
}  // namespace maximin
