#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <maximin/deep/mean_state.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensors.hpp>

#include "input_errors.hpp"

namespace maximin::deep::set_beliefs_test {  // of its own: built as one unit with its neighbours
namespace {

constexpr Lane lanes = 5;

/// Some lanes of episodes of random actions, whose truth is shown anywhere in the ball of radius `shown_eps`.
class Wanderers {
 public:
  explicit Wanderers(double shown_eps) : ball_(shown_eps) {
    for (Lane l = 0; l < lanes; ++l) {
      streams.emplace_back(11, static_cast<std::uint64_t>(l));
      truths.push_back(world_.reset(streams.back()));
    }
    actions.resize(lanes);
    shown.resize(lanes);
    show();
  }

  /// The lanes whose episode ended and began anew.
  std::vector<Lane> step() {
    std::vector<Lane> anew;
    for (Lane l = 0; l < lanes; ++l) {
      const auto i = static_cast<std::size_t>(l);
      actions[i] = streams[i].below(8);
      const Outcome<Point> outcome = world_.step(truths[i], actions[i]);
      const bool over = outcome.terminal || streams[i].chance(0.03);
      truths[i] = over ? world_.reset(streams[i]) : outcome.next;
      if (over) anew.push_back(l);
    }
    show();
    return anew;
  }

  std::vector<Stream> streams;
  std::vector<Point> truths, shown;
  std::vector<Action> actions;

 private:
  void show() {
    // Corners of the ball now and then: the truth is then at the very edge of what is possible.
    for (std::size_t i = 0; i < truths.size(); ++i) {
      const Point t = truths[i];
      shown[i] = ball_.draw(t, streams[i]);
      if (streams[i].chance(0.3)) shown[i] = {ball_.low(t.x), ball_.high(t.y)};
    }
  }

  ContinuousGridworld world_;
  ObservationBall ball_;
};

const std::vector<Lane> every{0, 1, 2, 3, 4};

/// Whether the places are in the set, as far as floats can say.
bool in_set(const torch::Tensor& places, const BoxUnion& set) {
  const std::vector<Point> points = to_points(places);
  return std::all_of(points.begin(), points.end(), [&](Point p) {
    return std::any_of(set.boxes().begin(), set.boxes().end(), [&](const Box& b) {
      return p.x > b.x_low - 1e-6 && p.x < b.x_high + 1e-6 && p.y > b.y_low - 1e-6 && p.y < b.y_high + 1e-6;
    });
  });
}

/// What is wrong with a belief of radius 0.3 in 300 steps of what is shown within `shown_eps`.
std::string flaw_of(SetBelief kind, long k, double shown_eps) {
  const ObservationBall ball(0.3);
  SetBeliefs belief(kind, ball, k), of_ball(SetBelief::ball, ball, 1);
  Wanderers w(shown_eps);
  belief.resize(lanes);
  of_ball.resize(lanes);
  std::vector<BoxBelief> exact(lanes, BoxBelief(ball));
  std::vector<Lane> anew = every;
  for (int step = 0; step < 300; ++step) {
    const BeliefStates m = belief.update(every, w.actions, w.shown);
    of_ball.update(every, w.actions, w.shown);
    if (m.states.sizes() != torch::IntArrayRef({lanes, k, 2}) || m.weights.sizes() != torch::IntArrayRef({lanes, k})) {
      return "sizes";
    }
    if (!torch::allclose(m.weights, torch::full({lanes, k}, 1.0 / static_cast<double>(k)))) return "weights";
    for (const Lane l : every) {
      const auto i = static_cast<std::size_t>(l);
      if (std::find(anew.begin(), anew.end(), l) != anew.end()) {
        exact[i].reset(w.shown[i]);
      } else {
        exact[i].update(w.actions[i], w.shown[i]);
      }
      if (!belief.holds(l, w.truths[i])) return "the truth is not held";
      if (!in_set(m.states[l], belief.set(l))) return "a state outside the set";
      if (belief.size(l) > of_ball.size(l) + 1e-12 || belief.size(l) <= 0) return "size";
      const BoxBelief& wanted = exact[i];
      if (kind == SetBelief::exact && !(belief.set(l) == wanted.belief())) return "not the exact filter's set";
    }
    anew = w.step();
    for (const Lane l : anew) belief.forget(l);
  }
  return belief.empty_intersections() == 0 ? "" : "empty";
}

TEST(SetBeliefs, HoldTheTruthAndSpreadTheirStatesInTheSet) {
  for (const SetBelief kind : {SetBelief::ball, SetBelief::exact}) {
    for (const long k : {1L, 7L, 32L}) EXPECT_EQ(flaw_of(kind, k, 0.3), "");
    // Shown farther away than is believed possible, the truth is lost.
    EXPECT_EQ(flaw_of(kind, 7, 0.6), "the truth is not held");
  }
  EXPECT_FALSE(in_set(torch::tensor({{9.5F, 9.5F}, {1.5F, 1.5F}}), open_area()));  // the second is in a wall
  for (const long k : {0L, -1L, 4097L}) {
    EXPECT_TRUE(is_refusal(refusal([&] { SetBeliefs(SetBelief::ball, ObservationBall(0.3), k); })));
  }
}

/// What is wrong with looking ahead: `update` in place of `peek` must be found out.
std::string flaw_of_peek(LaneBelief& belief, bool remembers) {
  Wanderers w(0.3);
  belief.resize(lanes);
  for (int step = 0; step < 60; ++step) {
    const std::vector<Lane> asked{3, 0, 3, 4, 3, 1, 2};
    std::vector<Action> actions;
    std::vector<Point> shown;
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const auto l = static_cast<std::size_t>(asked[k]);
      actions.push_back(w.actions[l]);
      shown.push_back(k == 2 ? w.truths[l] : w.shown[l]);  // lane 3 is asked for another place too
    }
    const BeliefStates ahead = belief.peek(asked, actions, shown);
    if (remembers) belief.update(every, w.actions, w.truths);
    const BeliefStates m = belief.update(every, w.actions, w.shown);
    for (const std::size_t k : {0U, 1U, 3U, 4U, 5U, 6U}) {
      const auto row = static_cast<long>(k);
      if (!ahead.states[row].equal(m.states[asked[k]])) return "another belief than update's";
      if (!ahead.weights[row].equal(m.weights[asked[k]])) return "other weights than update's";
    }
    for (const Lane l : w.step()) belief.forget(l);
  }
  return "";
}

TEST(SetBeliefs, PeekForeseesUpdateAndLanesDoNotDependOnEachOther) {
  const ObservationBall ball(0.3);
  SetBeliefs exact(SetBelief::exact, ball, 6), of_ball(SetBelief::ball, ball, 6);
  ObservedState observed;
  EXPECT_EQ(flaw_of_peek(exact, false), "");
  EXPECT_EQ(flaw_of_peek(of_ball, false), "");
  EXPECT_EQ(flaw_of_peek(observed, false), "");
  EXPECT_NE(flaw_of_peek(exact, true), "");

  // Lanes in another order, and fewer at a time, are the same beliefs.
  SetBeliefs together(SetBelief::exact, ball, 6), apart(SetBelief::exact, ball, 6);
  together.resize(lanes);
  apart.resize(lanes);
  Wanderers w(0.3);
  bool moved = false;
  for (int step = 0; step < 60; ++step) {
    const BeliefStates all = together.update(every, w.actions, w.shown);
    for (const std::vector<Lane>& some : {std::vector<Lane>{4, 1}, {0}, {3, 2}}) {
      std::vector<Action> actions;
      std::vector<Point> shown;
      for (const Lane l : some) {
        actions.push_back(w.actions[static_cast<std::size_t>(l)]);
        shown.push_back(w.shown[static_cast<std::size_t>(l)]);
      }
      const BeliefStates m = apart.update(some, actions, shown);
      for (std::size_t k = 0; k < some.size(); ++k) {
        ASSERT_TRUE(m.states[static_cast<long>(k)].equal(all.states[some[k]]));
        moved = moved || !m.states[static_cast<long>(k)].equal(all.states[(some[k] + 1) % lanes]);
      }
    }
    for (const Lane l : w.step()) {
      together.forget(l);
      apart.forget(l);
    }
  }
  EXPECT_TRUE(moved);  // beliefs of other lanes are others

  // What cannot be is counted, and the observation trusted.
  together.resize(1);
  together.update(std::vector<Lane>{0}, std::vector<Action>{0}, std::vector<Point>{{0.5, 0.5}});
  EXPECT_EQ(together.empty_intersections(), 0);
  together.update(std::vector<Lane>{0}, std::vector<Action>{0}, std::vector<Point>{{8.5, 4.5}});
  EXPECT_EQ(together.empty_intersections(), 1);
  EXPECT_TRUE(together.holds(0, {8.5, 4.5}));
}

/// The mean of a belief is one state, its middle, and says of the set what the belief says.
TEST(MeanState, IsTheMeanOfTheWholeBelief) {
  const ObservationBall ball(0.5);
  const auto whole = std::make_shared<SetBeliefs>(SetBelief::exact, ball, 64);
  MeanState mean(std::make_shared<SetBeliefs>(SetBelief::exact, ball, 64));
  Wanderers w(0.5);
  std::vector<Lane> all;
  for (Lane l = 0; l < lanes; ++l) all.push_back(l);
  whole->resize(lanes);
  mean.resize(lanes);
  for (int t = 0; t < 10; ++t) {
    const BeliefStates peeked = mean.peek(all, w.actions, w.shown);
    const BeliefStates states = whole->update(all, w.actions, w.shown), one = mean.update(all, w.actions, w.shown);
    ASSERT_EQ(one.states.size(1), mean.states_per_belief());
    const torch::Tensor expected = (states.states * states.weights.unsqueeze(2)).sum(1);
    EXPECT_TRUE(torch::allclose(one.states.select(1, 0), expected, 0, 1e-5));
    EXPECT_TRUE(torch::equal(one.states, peeked.states));
    EXPECT_FALSE(torch::allclose(one.states.select(1, 0), states.states.select(1, 0)));
    for (Lane l = 0; l < lanes; ++l) {
      EXPECT_EQ(mean.holds(l, w.truths[static_cast<std::size_t>(l)]), true);
      EXPECT_EQ(mean.size(l), whole->size(l));
    }
    for (const Lane l : w.step()) {
      whole->forget(l);
      mean.forget(l);
    }
  }
}

}  // namespace
}  // namespace maximin::deep::set_beliefs_test
