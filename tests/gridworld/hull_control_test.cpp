#include <maximin/gridworld/hull_control.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <maximin/theory/error.hpp>
#include <maximin/theory/rollout.hpp>

namespace maximin {
namespace {

static_assert(Agent<HullAgent>);

/// Shows what leaves the agent sure of least, of many observations: it knows the agent through and through.
struct LeastSure {
  ObservationBall ball;

  Point perturb(Point truth, const HullAgent& agent, Stream& rng) const {
    Point worst = truth;
    double least = agent.control().choice(agent.would_believe(truth)).value;
    for (int k = 0; k < 24; ++k) {
      const Point wanted{truth.x + rng.integer(-1, 1) * 9, truth.y + rng.integer(-1, 1) * 9};
      const Point shown = k % 2 == 0 ? ball.project(truth, wanted) : ball.draw(truth, rng);
      const double value = agent.control().choice(agent.would_believe(shown)).value;
      if (value >= least) continue;
      least = value;
      worst = shown;
    }
    return worst;
  }
};

struct AnywhereInTheBall {
  ObservationBall ball;
  Point perturb(Point truth, const HullAgent&, Stream& rng) const { return ball.draw(truth, rng); }
};

struct AlwaysAside {
  ObservationBall ball;
  Point perturb(Point truth, const HullAgent&, Stream&) const {
    return ball.project(truth, {truth.x + 9, truth.y - 9});
  }
};

struct Played {
  int broken_at_first = 0;    ///< episodes that paid less than was sure when the first observation was shown
  int broken_from_start = 0;  ///< than was sure from the start
  int broken_on_the_way = 0;  ///< steps after which less was sure than before
  double mean = 0;
};

template <class AttackT>
Played play(const HullControl& control, AttackT attack, int episodes) {
  ContinuousGridworld world;
  HullAgent agent(control);
  Played played;
  for (int k = 0; k < episodes; ++k) {
    Stream rng(21, static_cast<std::uint64_t>(k));
    double at_first = 0, from_start = 0, before = 0;
    const Episode e = rollout(world, agent, attack, 1, 100, rng, [&](const auto& record, const HullAgent& now) {
      if (!control.covers(now.belief_model().belief())) return;  // an attacker has broken the rules
      const double sure = control.choice(now.belief_model().belief()).value;
      if (record.time == 0) {
        at_first = sure;
        from_start = control.sure_from(record.truth);
      } else {
        played.broken_on_the_way += sure < before + 1;  // a step has been paid
      }
      before = sure;
    });
    played.mean += e.total_reward / episodes;
    played.broken_at_first += e.total_reward < at_first;
    played.broken_from_start += e.total_reward < from_start || from_start > at_first;
  }
  return played;
}

double mean_sure(const HullControl& control) {
  double sum = 0;
  const auto starts = open_area().spread(4000);
  for (const Point p : starts) sum += control.sure_from(p);
  return sum / 4000;
}

TEST(HullControl, KeepsItsWordWhoeverAttacks) {
  for (const double eps : {0.1, 0.5}) {
    const ObservationBall ball(eps);
    const HullControl control(ball, eps < 0.3 ? 5 : 3);
    const double sure = mean_sure(control);
    const auto keeps = [&](const Played& played) {
      EXPECT_EQ(played.broken_at_first, 0) << eps;
      EXPECT_EQ(played.broken_from_start, 0) << eps;
      EXPECT_EQ(played.broken_on_the_way, 0) << eps;
      EXPECT_GT(played.mean, sure - 5) << eps;
    };
    keeps(play(control, LeastSure{ball}, 300));
    keeps(play(control, AnywhereInTheBall{ball}, 300));
    keeps(play(control, AlwaysAside{ball}, 300));
  }
}

/// From every start, at eps 0.1; at 0.5 from all but the corridor above the bomb, which no hull leaves for
/// sure, and what can be confused with it.
TEST(HullControl, IsSureOfTheGold) {
  const HullControl fine(ObservationBall(0.1), 5);
  EXPECT_GT(mean_sure(fine), 183);
  double least = 200;
  for (const Point p : open_area().spread(2000)) least = std::min(least, fine.sure_from(p));
  EXPECT_GT(least, 140);
  const HullControl coarse(ObservationBall(0.5), 4);
  EXPECT_GT(mean_sure(coarse), 164);
  for (const Point p : open_area().spread(2000)) {
    if (p.x >= 8 && p.y >= 5) continue;
    EXPECT_GT(coarse.sure_from(p), 160) << p.x << ' ' << p.y;
  }
  const HullControl exact(ObservationBall(0), 10);
  EXPECT_GT(mean_sure(exact), mean_sure(fine));
  EXPECT_LT(mean_sure(exact), 188.5) << "no more than the optimum without attack";
}

TEST(HullControl, TheTestFindsAnAgentThatTrustsTooMuch) {
  const HullControl trusting(ObservationBall(0.1), 5);
  const Played played = play(trusting, AnywhereInTheBall{ObservationBall(0.5)}, 300);
  EXPECT_GT(played.broken_at_first, 30);
  EXPECT_GT(played.broken_on_the_way, 100);
}

TEST(HullControl, RefusesWhatItCannotDo) {
  const ObservationBall ball(0.5);
  EXPECT_THROW(HullControl(ball, 0), InputError);
  EXPECT_THROW(HullControl(ball, 100), InputError);
  EXPECT_THROW(HullControl(ObservationBall(5), 4), InputError);
  EXPECT_THROW(HullControl(ball, 2, {.start_anywhere = true}), InputError);
  const HullControl control(ball, 2);
  EXPECT_THROW(control.choice(BoxUnion()), std::invalid_argument);
  EXPECT_THROW(control.choice(open_area()), std::invalid_argument);
  EXPECT_THROW(control.sure_from({9.5, 4.5}), std::invalid_argument);
  EXPECT_FALSE(control.covers(BoxUnion()));
  EXPECT_FALSE(control.covers(open_area()));
  EXPECT_TRUE(control.covers(BoxBelief(ball).reset({5, 5})));
  EXPECT_GT(control.hulls(), 1000);
}

}  // namespace
}  // namespace maximin
