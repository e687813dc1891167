#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/pf_rnn_belief.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/deep/wandering.hpp>
#include <maximin/gridworld/box_belief.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// An untrained network; `loudness` multiplies what it reads, so that its places leave the ball.
PfRnnPtr make(double loudness = 1, PfCell cell = PfCell::lstm) {
  PfRnnOptions options;
  options.cell = cell;
  options.eps = 0.5;
  Stream rng(1);
  auto module = std::make_shared<PfRnn>(options, rng);
  const torch::NoGradGuard no_grad;
  for (auto& item : module->named_parameters()) {
    if (item.key().starts_with("read.")) item.value().mul_(loudness);
  }
  return module;
}

bool close(const BeliefStates& a, const BeliefStates& b) {
  return torch::allclose(a.states, b.states, 0, 1e-4) && torch::allclose(a.weights, b.weights, 0, 1e-4);
}

BeliefStates row(const BeliefStates& all, long k) {
  return {all.states.narrow(0, k, 1), all.weights.narrow(0, k, 1)};
}

/// Episodes in step: their sights at each time.
struct Histories {
  std::vector<Wandering> lanes;

  explicit Histories(int count) {
    for (int l = 0; l < count; ++l) {
      lanes.emplace_back(Walk::persistent, Deception::flipping, 0.5, 8, 1000);
      lanes.back().begin(5, static_cast<std::uint64_t>(l));
    }
  }
  std::vector<Point> shown() const {
    std::vector<Point> all;
    for (const Wandering& lane : lanes) all.push_back(lane.shown());
    return all;
  }
  std::vector<Action> actions() const {
    std::vector<Action> all;
    for (const Wandering& lane : lanes) all.push_back(lane.last_action());
    return all;
  }
  void step() {
    for (std::size_t l = 0; l < lanes.size(); ++l) {
      if (!lanes[l].step()) lanes[l].begin(6, l);
    }
  }
};

TEST(PfRnnBelief, LanesDoNotKnowOfEachOtherAndPeekForeseesUpdate) {
  for (const PfCell cell : {PfCell::lstm, PfCell::gru}) {
    const PfRnnPtr module = make(1, cell);
    PfBeliefOptions other_seed;
    other_seed.seed = 2;
    PfRnnBelief together(module), alone(module), different(module, other_seed);
    together.resize(3);
    alone.resize(5);
    different.resize(3);
    Histories histories(3);
    bool peek_depends_on_shown = false, seed_tells = false, lanes_differ = false;
    for (int t = 0; t < 6; ++t, histories.step()) {
      const std::vector<Point> shown = histories.shown();
      const std::vector<Action> actions = histories.actions();
      // Lanes more than once, other observations, any order: and nothing is remembered.
      const Point elsewhere{shown[1].x + 0.25, shown[1].y};
      const BeliefStates foreseen = together.peek(std::vector<Lane>{1, 0, 1, 2},
                                                  std::vector<Action>{actions[1], actions[0], actions[1], actions[2]},
                                                  std::vector<Point>{shown[1], shown[0], elsewhere, shown[2]});
      const BeliefStates belief =
          together.update(std::vector<Lane>{2, 1, 0}, std::vector<Action>{actions[2], actions[1], actions[0]},
                          std::vector<Point>{shown[2], shown[1], shown[0]});
      EXPECT_TRUE(close(row(foreseen, 0), row(belief, 1)));
      EXPECT_TRUE(close(row(foreseen, 1), row(belief, 2)));
      EXPECT_TRUE(close(row(foreseen, 3), row(belief, 0)));
      peek_depends_on_shown = peek_depends_on_shown || !close(row(foreseen, 2), row(belief, 1));
      // The same episode in another lane, by itself.
      const BeliefStates same =
          alone.update(std::vector<Lane>{4}, std::vector<Action>{actions[1]}, std::vector<Point>{shown[1]});
      EXPECT_TRUE(close(same, row(belief, 1)));
      const BeliefStates reseeded =
          different.update(std::vector<Lane>{1}, std::vector<Action>{actions[1]}, std::vector<Point>{shown[1]});
      seed_tells = seed_tells || !close(reseeded, row(belief, 1));
      lanes_differ = lanes_differ || !close(row(belief, 0), row(belief, 1));
      EXPECT_LT((belief.weights.sum(1) - 1).abs().max().item<double>(), 1e-5);
      EXPECT_FALSE(belief.states.is_inference());
    }
    EXPECT_TRUE(peek_depends_on_shown && seed_tells && lanes_differ);
  }
}

TEST(PfRnnBelief, ForgetsWhatWasBefore) {
  const PfRnnPtr module = make();
  PfBeliefOptions never;
  never.forgets = false;
  const std::vector<Lane> lane{0};
  const std::vector<Point> first{{2.5, 4.5}}, second{{2.75, 4.75}};
  const std::vector<Action> action{1};
  PfRnnBelief belief(module), released(module, never);
  std::vector<BeliefStates> fresh, again;
  for (PfRnnBelief* b : {&belief, &released}) {
    b->resize(2);
    EXPECT_TRUE(b->holds(0, {9.5, 9.5}));
    fresh.push_back(b->update(lane, action, first));
    EXPECT_FALSE(b->holds(0, {9.5, 9.5}));
    b->update(lane, action, second);
    b->forget(0);
    again.push_back(b->update(lane, action, first));
  }
  EXPECT_TRUE(close(fresh[0], again[0]));
  EXPECT_FALSE(close(fresh[1], again[1]));
  EXPECT_TRUE(close(fresh[0], fresh[1]));
}

TEST(PfRnnBelief, CorrectedStatesArePossible) {
  const ObservationBall ball(0.5);
  for (const bool correct : {true, false}) {
    PfBeliefOptions options;
    options.correct = correct;
    options.hull_margin = 0;
    PfRnnBelief belief(make(8), options);
    Histories histories(20);
    belief.resize(20);
    std::vector<Lane> lanes;
    for (Lane l = 0; l < 20; ++l) lanes.push_back(l);
    long impossible = 0;
    for (int t = 0; t < 20; ++t, histories.step()) {
      const std::vector<Point> shown = histories.shown();
      const BeliefStates states = belief.update(lanes, histories.actions(), shown);
      for (Lane l = 0; l < 20; ++l) {
        const BoxUnion possible = open_area().meet(ball.around(shown[static_cast<std::size_t>(l)]));
        for (const Point& p : to_points(states.states[l])) {
          impossible += !possible.contains(p);
          EXPECT_TRUE(belief.holds(l, p) || p.x == to_points(states.states[l].amax(0).unsqueeze(0))[0].x ||
                      p.y == to_points(states.states[l].amax(0).unsqueeze(0))[0].y);
        }
        EXPECT_FALSE(belief.holds(l, {shown[static_cast<std::size_t>(l)].x + 9, 5}));
        EXPECT_GE(belief.size(l), 0);
        EXPECT_TRUE(belief.size(l) <= 1.0 + 1e-9 || !correct);
      }
    }
    EXPECT_EQ(impossible == 0, correct);
    EXPECT_TRUE(correct || belief.empty_intersections() == 0);
  }
  // Places far from every ball: none meets the observation, and the ball takes their place.
  PfRnnBelief lost(make(1000));
  lost.resize(1);
  const BeliefStates fallback =
      lost.update(std::vector<Lane>{0}, std::vector<Action>{0}, std::vector<Point>{{4.5, 4.5}});
  EXPECT_EQ(lost.empty_intersections(), 1);
  EXPECT_TRUE(torch::allclose(fallback.weights, torch::full({1, 30}, 1.0 / 30)));
  EXPECT_GT(lost.size(0), 0.5);
  lost.peek(std::vector<Lane>{0}, std::vector<Action>{0}, std::vector<Point>{{4.5, 4.5}});
  EXPECT_EQ(lost.empty_intersections(), 1);
  PfBeliefOptions nonsense;
  nonsense.slack = -1;
  EXPECT_THROW(PfRnnBelief(make(), nonsense), InputError);
}

}  // namespace
}  // namespace maximin::deep
