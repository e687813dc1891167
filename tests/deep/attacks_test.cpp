#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/attacks/adaptive_director.hpp>
#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/mixed_attack.hpp>
#include <maximin/deep/attacks/named_attack.hpp>
#include <maximin/deep/attacks/network_search.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/pa_ad_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/attacks/targeted_search.hpp>
#include <maximin/deep/attacks/through_defence_attack.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/theory/error.hpp>

#include <unistd.h>

#include "lattice_values.hpp"
#include "tiny_networks.hpp"

namespace maximin::deep {
namespace {

struct Case {
  std::string name;
  std::shared_ptr<GridAttack> attack;
};

QNetworkPtr small_network(std::uint64_t seed) {
  Stream rng(seed);
  return random_network({.hidden = {32, 32}, .waves = 2}, rng, torch::kFloat, 2.5);
}

/// Every attack there is, on this network.
std::vector<Case> all_attacks(const QNetworkPtr& q, const ObservationBall& ball) {
  std::vector<Case> all;
  all.push_back({"random", std::make_shared<RandomAttack>(ball)});
  for (const CornerChange change : {CornerChange::never, CornerChange::opposite, CornerChange::drawn}) {
    all.push_back({"offset", std::make_shared<ConstantOffsetAttack>(ball, OffsetOptions{std::nullopt, change})});
  }
  for (const auto objective : {AttackObjective::value, AttackObjective::cross_entropy, AttackObjective::min_best}) {
    GradientAttackOptions options;
    options.objective = objective;
    all.push_back({"gradient", std::make_shared<GradientAttack>(q, ball, options)});
    options.keep_best = false;
    options.released_start = true;
    all.push_back({"gradient, as released", std::make_shared<GradientAttack>(q, ball, options)});
  }
  for (const char* name : {"pgd-search", "min-best-search"}) {
    all.push_back({"search", std::make_shared<NetworkSearch>(q, ball, network_search_named(name))});
  }
  all.push_back({"best response", std::make_shared<BestResponseAttack>(q, ball, BestResponseOptions{})});
  all.push_back({"through defence", std::make_shared<ThroughDefenceAttack>(q, ball)});
  PaAdOptions pa_ad;
  all.push_back({"pa-ad", std::make_shared<PaAdAttack>(q, ball, pa_ad)});
  pa_ad.actor.method = SearchMethod::pgd;
  all.push_back({"pa-ad, pgd", std::make_shared<PaAdAttack>(q, ball, pa_ad)});
  all.push_back({"adaptive director", std::make_shared<AdaptiveDirector>(q, ball)});
  std::vector<MixedAttack::Part> parts{{std::make_shared<RandomAttack>(ball), 1},
                                       {std::make_shared<ConstantOffsetAttack>(ball), 2}};
  all.push_back({"mixed", std::make_shared<MixedAttack>(std::move(parts))});
  return all;
}

/// Places where balls are cut: corners and edges of the world, and some in its middle.
std::vector<Point> delicate_places() {
  const double last = gridworld::side - gridworld::quantum;
  std::vector<Point> places;
  for (const double x : {0.0, 0.03125, 4.5, last}) {
    for (const double y : {0.0, 5.25, 9.96875, last}) places.push_back({x, y});
  }
  return places;
}

/// A few steps in which the truth stays where it is.
std::vector<Point> shown_by(GridAttack& attack, GridAgent& agent, const std::vector<Point>& truths,
                            std::uint64_t seed) {
  std::vector<Lane> lanes;
  std::vector<Stream> streams;
  for (std::size_t l = 0; l < truths.size(); ++l) {
    lanes.push_back(static_cast<Lane>(l));
    streams.emplace_back(seed, l);
  }
  agent.resize(static_cast<Lane>(lanes.size()));
  attack.resize(static_cast<Lane>(lanes.size()));
  std::vector<Point> shown(truths.size()), all;
  std::vector<Action> actions(truths.size());
  for (int step = 0; step < 3; ++step) {
    attack.perturb(lanes, truths, agent, streams, shown);
    agent.act(lanes, shown, streams, actions);
    all.insert(all.end(), shown.begin(), shown.end());
  }
  return all;
}

BeliefAgent agent_of(const QNetworkPtr& q, const ObservationBall& ball, const std::string& aggregator) {
  return BeliefAgent(q, std::make_shared<SetBeliefs>(SetBelief::exact, ball, 8), aggregator_named(aggregator));
}

/// Shows a place just outside the ball.
class Trespasser final : public GridAttack {
 public:
  explicit Trespasser(double aside) : aside_(aside) {}
  void perturb(std::span<const Lane>, std::span<const Point> truths, const GridAgent&, std::span<Stream>,
               std::span<Point> shown) override {
    for (std::size_t k = 0; k < truths.size(); ++k) shown[k] = {truths[k].x + aside_, truths[k].y};
  }

 private:
  double aside_;
};

TEST(Attacks, KeepToBallAndWorldAndToTheirStreams) {
  for (const double eps : {0.0, 0.1, 0.5}) {
    const ObservationBall ball(eps);
    const QNetworkPtr q = small_network(3);
    BeliefAgent agent = agent_of(q, ball, "mean");
    for (const Case& one : all_attacks(q, ball)) {
      SCOPED_TRACE(one.name);
      WithinBallInStep within(*one.attack, ball);
      const std::vector<Point> first = shown_by(within, agent, delicate_places(), 5);
      EXPECT_EQ(first, shown_by(within, agent, delicate_places(), 5));
      const bool draws = one.name == "random" || one.name == "gradient";
      if (eps > 0 && draws) {
        EXPECT_NE(first, shown_by(within, agent, delicate_places(), 6));
      }
    }
    for (const double aside : {eps + gridworld::quantum, -eps - gridworld::quantum, 1e-14}) {
      Trespasser outside(aside);
      WithinBallInStep within(outside, ball);
      EXPECT_THROW(shown_by(within, agent, {{5, 5}}, 1), std::logic_error) << aside;
    }
  }
}

TEST(Attacks, OffsetsStayOrChangeAsNamed) {
  const ObservationBall ball(0.25);
  BeliefAgent agent = agent_of(small_network(3), ball, "mean");
  const std::vector<Point> truths{{5, 5}, {4.5, 5}, {5, 4.5}, {4, 5}, {3, 5}, {2, 5}};
  const auto offsets = [&](const OffsetOptions& options) {
    ConstantOffsetAttack attack(ball, options);
    std::vector<Point> shown = shown_by(attack, agent, truths, 9);
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const Point s = truths[k % truths.size()];
      shown[k] = {shown[k].x - s.x, shown[k].y - s.y};
    }
    return shown;
  };
  const auto at = [&](const std::vector<Point>& all, int step, std::size_t lane) {
    return all[static_cast<std::size_t>(step) * truths.size() + lane];
  };
  const auto constant = offsets({}), opposite = offsets({std::nullopt, CornerChange::opposite});
  const auto drawn = offsets({std::nullopt, CornerChange::drawn});
  bool lanes_differ = false, steps_differ = false;
  for (std::size_t lane = 0; lane < truths.size(); ++lane) {
    const Point first = at(constant, 0, lane);
    EXPECT_EQ(std::abs(first.x), ball.eps());
    EXPECT_EQ(std::abs(first.y), ball.eps());
    EXPECT_EQ(first, at(constant, 2, lane));
    EXPECT_EQ(at(opposite, 0, lane), first);
    EXPECT_EQ(at(opposite, 1, lane), (Point{-first.x, -first.y}));
    EXPECT_EQ(at(opposite, 2, lane), first);
    lanes_differ |= !(first == at(constant, 0, 0));
    steps_differ |= !(at(drawn, 0, lane) == at(drawn, 1, lane));
  }
  EXPECT_TRUE(lanes_differ);
  EXPECT_TRUE(steps_differ);
  for (const Point& p : offsets({Corner::upper_left})) EXPECT_EQ(p, (Point{-ball.eps(), ball.eps()}));
}

/// What the judge says of the action that is provoked by each of these observations of the truth.
std::vector<double> provoked_values(const BeliefAgent& agent, QNetwork& judge, Lane lane, Point truth,
                                    const std::vector<Point>& shown) {
  torch::NoGradGuard no_grad;
  const std::vector<Lane> lanes(shown.size(), lane);
  std::vector<Action> actions(shown.size());
  agent.would_do(lanes, shown, actions);
  const torch::Tensor q = judge.forward(to_tensor(std::vector<Point>{truth}));
  std::vector<double> values;
  for (const Action a : actions) values.push_back(q[0][a].item<double>());
  return values;
}

std::vector<Point> whole_grid(const ObservationBall& ball, Point truth, int n) {
  std::vector<Point> places;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) places.push_back(grid_place(ball, truth, n, i, j));
  }
  return places;
}

std::vector<Point> places_in_the_open(int count) {
  const ContinuousGridworld world;
  Stream rng(77);
  std::vector<Point> places;
  for (int i = 0; i < count; ++i) places.push_back(world.reset(rng));
  return places;
}

/// Mean over the lanes of the value of the action that the attack provokes at once.
double mean_provoked(GridAttack& attack, const BeliefAgent& agent, QNetwork& judge, const std::vector<Point>& truths) {
  std::vector<Lane> lanes;
  std::vector<Stream> streams;
  for (std::size_t l = 0; l < truths.size(); ++l) {
    lanes.push_back(static_cast<Lane>(l));
    streams.emplace_back(4, l);
  }
  attack.resize(static_cast<Lane>(lanes.size()));
  std::vector<Point> shown(truths.size());
  attack.perturb(lanes, truths, agent, streams, shown);
  double sum = 0;
  for (std::size_t l = 0; l < truths.size(); ++l) {
    sum += provoked_values(agent, judge, lanes[l], truths[l], {shown[l]})[0];
  }
  return sum / static_cast<double>(truths.size());
}

TEST(Attacks, AreAsStrongInOneStepAsTheyClaim) {
  const ObservationBall ball(0.4);
  const QNetworkPtr q = small_network(11);
  const std::vector<Point> truths = places_in_the_open(60);
  BeliefAgent greedy(q, std::make_shared<ObservedState>(), MeanAggregator{});
  BeliefAgent defended = agent_of(q, ball, "min");
  for (BeliefAgent* agent : {&greedy, &defended}) {
    // One step of belief first, so that the defence has something to remember.
    RandomAttack random(ball);
    shown_by(random, *agent, truths, 21);
    double least = 0;
    for (std::size_t l = 0; l < truths.size(); ++l) {
      const auto all = provoked_values(*agent, *q, static_cast<Lane>(l), truths[l], whole_grid(ball, truths[l], 41));
      least += *std::min_element(all.begin(), all.end()) / static_cast<double>(truths.size());
    }
    const auto provoked = [&](GridAttack&& attack) { return mean_provoked(attack, *agent, *q, truths); };
    const double none = provoked(NoAttack()), by_chance = provoked(RandomAttack(ball));
    const double pgd = provoked(GradientAttack(q, ball, {}));
    const double best_response = provoked(BestResponseAttack(q, ball, {21, 0}));
    const double through = provoked(ThroughDefenceAttack(q, ball));
    // The fine grid may itself miss a sliver of the ball: hence 0.01 of the span.
    const double slack = 0.01 * (none - least);
    ASSERT_LT(least, none - 0.1);
    EXPECT_GE(best_response, least - slack);
    EXPECT_GE(through, least - slack);
    EXPECT_GE(pgd, least - slack);
    EXPECT_LE(best_response, least + 0.05 * (none - least));
    EXPECT_LE(best_response, pgd + slack);
    // It begins with the very looks of the sampled best response.
    EXPECT_LE(through, provoked(BestResponseAttack(q, ball, {3, 16})));
    EXPECT_LT(through, provoked(ThroughDefenceAttack(q, ball, {.steps = 0, .grid = 0, .random = 4})));
    EXPECT_LE(through, least + 0.1 * (none - least));
    // PGD knows the network, not the defence.
    if (agent == &greedy) {
      EXPECT_LT(pgd, by_chance);
    }
  }
}

/// What an attack on a network makes small, at these observations of the truth.
std::vector<double> objectives(AttackObjective objective, QNetwork& q, Point truth, const std::vector<Point>& shown) {
  torch::NoGradGuard no_grad;
  const torch::Tensor at = q.forward(to_tensor(shown)), here = q.forward(to_tensor(std::vector<Point>{truth}));
  torch::Tensor value = here.expand_as(at).gather(1, at.argmax(1, true));
  if (objective == AttackObjective::min_best) value = torch::softmax(at, 1).narrow(1, here.argmax().item<long>(), 1);
  if (objective == AttackObjective::cross_entropy) {
    value = torch::log_softmax(at, 1).narrow(1, here.argmax().item<long>(), 1);
  }
  std::vector<double> all;
  for (long i = 0; i < value.size(0); ++i) all.push_back(value[i][0].item<double>());
  return all;
}

/// How far an attack on a network comes from what chance shows (0) to the least that a fine grid finds (1).
double way_to_the_least(GridAttack&& attack, AttackObjective objective, QNetwork& q, const ObservationBall& ball) {
  const std::vector<Point> truths = places_in_the_open(60);
  BeliefAgent unused(small_network(1), std::make_shared<ObservedState>(), MeanAggregator{});
  RandomAttack random(ball);
  const std::vector<Point> by_attack = shown_by(attack, unused, truths, 3),
                           by_chance = shown_by(random, unused, truths, 8);
  double reached = 0, chance = 0, least = 0;
  for (std::size_t k = 0; k < truths.size(); ++k) {
    reached += objectives(objective, q, truths[k], {by_attack[k]})[0];
    const std::vector<double> all = objectives(objective, q, truths[k], whole_grid(ball, truths[k], 41));
    least += *std::min_element(all.begin(), all.end());
  }
  for (std::size_t k = 0; k < by_chance.size(); ++k) {
    chance += objectives(objective, q, truths[k % truths.size()], {by_chance[k]})[0];
  }
  chance /= static_cast<double>(by_chance.size()) / static_cast<double>(truths.size());
  return (chance - reached) / (chance - least);
}

TEST(Attacks, GradientsMakeTheirOwnObjectivesSmall) {
  const ObservationBall ball(0.4);
  const QNetworkPtr q = small_network(11);
  for (const char* name : {"pgd", "min-best", "pgd-restarts", "pgd-released"}) {
    SCOPED_TRACE(name);
    GradientAttackOptions options = gradient_attack_named(name);
    EXPECT_EQ(options.starts, std::string(name) == "pgd-restarts" ? 10 : 1);
    EXPECT_EQ(options.released_start, std::string(name) == "pgd-released");
    EXPECT_EQ(options.keep_best, !options.released_start);
    // From a wrong corner, and showing where it ends, it has nothing to boast of.
    options.released_start = false;
    options.keep_best = true;
    const double way = way_to_the_least(GradientAttack(q, ball, options), options.objective, *q, ball);
    EXPECT_GT(way, options.starts > 1 ? 0.8 : 0.45);
    EXPECT_LT(way, 1.05);
    // The same on the gradients of another network comes less far.
    const QNetworkPtr other = small_network(12);
    EXPECT_LT(way_to_the_least(GradientAttack(other, ball, options), options.objective, *q, ball), way - 0.1);
  }
  EXPECT_EQ(gradient_attack_named("pgd").objective, AttackObjective::value);
  EXPECT_EQ(gradient_attack_named("min-best").objective, AttackObjective::min_best);
  EXPECT_EQ(gradient_attack_named("pgd-released").objective, AttackObjective::cross_entropy);
  EXPECT_THROW(gradient_attack_named("pgd-"), InputError);
  // The released start: the corner of the ball that is nearest to the lower left corner of the world.
  GradientAttackOptions released = gradient_attack_named("pgd-released");
  released.steps = 0;
  GradientAttack start(q, ball, released);
  BeliefAgent unused(q, std::make_shared<ObservedState>(), MeanAggregator{});
  EXPECT_EQ(shown_by(start, unused, {{4.5, 6.5}}, 3)[0], grid_place(ball, {4.5, 6.5}, 2, 0, 0));
}

TEST(Attacks, SearchesFindWhatGradientsMiss) {
  const ObservationBall ball(0.4);
  const QNetworkPtr q = small_network(11);
  for (const std::string name : {"pgd", "min-best"}) {
    SCOPED_TRACE(name);
    const NetworkSearchOptions options = network_search_named(name + "-search");
    const GradientAttackOptions gradient = gradient_attack_named(name);
    EXPECT_EQ(options.objective, gradient.objective);
    const auto way = [&](GridAttack&& attack) {
      return way_to_the_least(std::move(attack), options.objective, *q, ball);
    };
    const double by_search = way(NetworkSearch(q, ball, options));
    EXPECT_GT(by_search, 0.9);
    EXPECT_LT(by_search, 1.05);
    // With no more looks than the gradient attack has, and none of them on a grid.
    const double by_gradient = way(GradientAttack(q, ball, gradient));
    EXPECT_GT(way(NetworkSearch(q, ball, {options.objective, 0, gradient.steps + 1})), by_gradient);
    // One look is chance; another network's values lead elsewhere.
    EXPECT_LT(std::abs(way(NetworkSearch(q, ball, {options.objective, 0, 1}))), 0.15);
    EXPECT_LT(way(NetworkSearch(small_network(12), ball, options)), 0.5);
  }
  EXPECT_THROW(network_search_named("search"), InputError);
  EXPECT_THROW(NetworkSearch(q, ball, {AttackObjective::value, 0, 0}), InputError);
  EXPECT_THROW(NetworkSearch(q, ball, {AttackObjective::value, 1, 4}), InputError);
}

TEST(Attacks, ASteadyBestResponseShowsTheNearestToItsLastErrorAmongEquals) {
  const ObservationBall ball(0.4);
  const QNetworkPtr q = small_network(11);
  const std::vector<Point> truths = places_in_the_open(40);
  BestResponseOptions options{5, 0, true};
  BestResponseAttack steady(q, ball, options);
  options.steady = false;
  BestResponseAttack restless(q, ball, options);
  BeliefAgent agent(q, std::make_shared<ObservedState>(), MeanAggregator{});
  const std::vector<Point> by_steady = shown_by(steady, agent, truths, 3),
                           by_restless = shown_by(restless, agent, truths, 3);
  const auto error_of = [&](const std::vector<Point>& shown, std::size_t k) {
    const Point s = truths[k % truths.size()];
    return Point{shown[k].x - s.x, shown[k].y - s.y};
  };
  const auto far = [](Point a, Point b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); };
  const auto out_of_place = [&](const std::vector<Point>& shown) {
    int count = 0;
    for (std::size_t k = truths.size(); k < shown.size(); ++k) {
      const Point truth = truths[k % truths.size()], last = error_of(shown, k - truths.size());
      const Point carried = ball.project(truth, {truth.x + last.x, truth.y + last.y});
      std::vector<Point> candidates = whole_grid(ball, truth, 5);
      candidates.push_back(carried);
      candidates.push_back(shown[k]);
      const std::vector<double> values = objectives(AttackObjective::value, *q, truth, candidates);
      const double least = *std::min_element(values.begin(), values.end());
      bool nearest = values.back() == least;
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        nearest = nearest && (values[c] > least || far(candidates[c], carried) >= far(shown[k], carried));
      }
      count += !nearest;
    }
    return count;
  };
  EXPECT_EQ(out_of_place(by_steady), 0);
  EXPECT_GT(out_of_place(by_restless), static_cast<int>(truths.size()) / 2);
}

TEST(Attacks, TargetedSearchProvokesWhatCanBeProvoked) {
  const ObservationBall ball(0.4);
  const QNetworkPtr q = small_network(12);
  const std::vector<Point> truths = places_in_the_open(30);
  BeliefAgent greedy(q, std::make_shared<ObservedState>(), MeanAggregator{});
  greedy.resize(static_cast<Lane>(truths.size()));
  std::vector<Lane> lanes;
  std::vector<Stream> streams;
  for (std::size_t l = 0; l < truths.size(); ++l) {
    lanes.push_back(static_cast<Lane>(l));
    streams.emplace_back(4, l);
  }
  for (const SearchMethod method : {SearchMethod::grid, SearchMethod::pgd}) {
    TargetedSearchOptions options;
    options.method = method;
    const TargetedSearch search(q, ball, options);
    int possible = 0, hit = 0, impossible_hit = 0;
    for (Action target = 0; target < ContinuousGridworld::actions; ++target) {
      const std::vector<int> targets(truths.size(), target);
      std::vector<Point> found(truths.size());
      std::vector<Action> done(truths.size());
      search.find(lanes, truths, targets, streams, found);
      greedy.would_do(lanes, found, done);
      for (std::size_t l = 0; l < truths.size(); ++l) {
        const auto grid = whole_grid(ball, truths[l], 41);
        std::vector<Action> answers(grid.size());
        greedy.would_do(std::vector<Lane>(grid.size(), lanes[l]), grid, answers);
        const bool can = std::find(answers.begin(), answers.end(), target) != answers.end();
        possible += can;
        hit += can && done[l] == target;
        impossible_hit += !can && done[l] == target;
      }
    }
    ASSERT_GT(possible, static_cast<int>(truths.size()));
    EXPECT_GE(hit, (method == SearchMethod::grid ? 0.9 : 0.5) * possible);
    EXPECT_LE(impossible_hit, 0.02 * possible + 1);
  }
}

TEST(Attacks, BadOptionsAreNamed) {
  const ObservationBall ball(0.1);
  const QNetworkPtr q = small_network(1);
  EXPECT_THROW(TargetedSearch(q, ball, {.grid = 1}), InputError);
  EXPECT_THROW(ThroughDefenceAttack(q, ball, {.starts = 0}), InputError);
  EXPECT_THROW(ThroughDefenceAttack(q, ball, {.grid = 0, .random = 3, .starts = 4}), InputError);
  EXPECT_THROW(AdaptiveDirector(q, ball, {.grid = 1}), InputError);
  PaAdOptions no_time;
  no_time.director.horizon = 0;
  EXPECT_THROW(PaAdAttack(q, ball, no_time), InputError);
  EXPECT_THROW(MixedAttack({}), std::invalid_argument);
  // Descent through a defence needs one.
  class Blind final : public GridAgent {
    void resize(Lane) override {}
    void forget(Lane) override {}
    void act(std::span<const Lane>, std::span<const Point>, std::span<Stream>, std::span<Action>) override {}
    void would_do(std::span<const Lane>, std::span<const Point>, std::span<Action>) const override {}
  };
  Blind blind;
  ThroughDefenceAttack through(q, ball);
  EXPECT_THROW(shown_by(through, blind, {{5, 5}}, 1), InputError);
}

/// A learned attack is one agent's: its file is refused for another, and for another length of training.
TEST(NamedAttack, ALearnedAttackBelongsToItsAgent) {
  AgentSpec spec = recipe("bp-dqn", 0.5, 1);
  const TrainedAgent agent = untrained(spec);
  spec.training.seed = 2;
  const TrainedAgent other = untrained(spec);
  const Acting acting = acting_of(spec);
  const auto target = [&](const TrainedAgent& a) {
    return AttackTarget{a.values_in_rewards(), a.values_in_rewards(), identity_of(a, acting),
                        [&a, acting] { return make_agent(a, acting); }, spec.training.reward_scale};
  };
  AttackSetting setting;
  setting.name = "pa-ad-adaptive";
  setting.eps = 0.5;
  setting.quick = true;
  setting.file = std::filesystem::temp_directory_path() / ("maximin-attacker-" + std::to_string(::getpid()));
  std::filesystem::remove(setting.file);
  long reports = 0;
  setting.progress = [&](double, double) { return ++reports > 0; };
  ASSERT_NE(make_attack(setting, target(agent)), nullptr);
  const long learning = reports;
  EXPECT_GT(learning, 0);
  EXPECT_NE(make_attack(setting, target(agent)), nullptr);
  EXPECT_EQ(reports, learning) << "read, not learned again";
  EXPECT_THROW(make_attack(setting, target(other)), InputError);
  setting.quick = false;
  EXPECT_THROW(make_attack(setting, target(agent)), InputError);
  std::filesystem::remove(setting.file);
}

/// Of three directors the one that leaves least; each is kept in a file of its own, the first of them `director`.
TEST(NamedAttack, TheWorstOfThreeDirectorsIsOneOfThem) {
  const auto values = std::make_shared<LatticeValues>();
  const auto agent = [&] {
    return std::make_unique<BeliefAgent>(values, std::make_shared<ObservedState>(), MeanAggregator{});
  };
  const AttackTarget target{values, values, "the lattice's values", agent};
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("maximin-directors-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  AttackSetting setting;
  setting.eps = 0.5;
  setting.quick = true;
  constexpr std::uint64_t trial_seed = 3 ^ (std::uint64_t{1} << 62U);  // of the episodes that choose
  const auto left = [&](const std::string& name, const std::string& file, std::uint64_t seed) {
    setting.name = name;
    setting.file = file.empty() ? std::filesystem::path() : folder / file;
    setting.seed = seed;
    const auto attack = make_attack(setting, target);
    return evaluate_agent(*agent(), *attack, ObservationBall(0.5), 16, trial_seed).returns;
  };
  const auto worst = left("directors", "d.attacker", 3);
  std::vector<std::vector<double>> each;
  for (const std::uint64_t k : {0, 1, 2}) {
    const std::string file = "d-" + std::to_string(k + 1) + ".attacker";
    ASSERT_TRUE(std::filesystem::exists(folder / file));
    each.push_back(left("director", file, 3 + k * 2'000'000));
  }
  EXPECT_NE(each[0], each[1]);
  EXPECT_NE(each[1], each[2]);
  EXPECT_EQ(left("director", "", 3), each[0]);
  const auto total = [](const auto& a, const auto& b) {
    return std::accumulate(a.begin(), a.end(), 0.0) < std::accumulate(b.begin(), b.end(), 0.0);
  };
  EXPECT_EQ(worst, *std::min_element(each.begin(), each.end(), total));
  // Three that are told to stop are none.
  setting.name = "directors";
  setting.file.clear();
  setting.progress = [](double, double) { return false; };
  EXPECT_EQ(make_attack(setting, target), nullptr);
  std::filesystem::remove_all(folder);
}

/// Values in another unit attack as they are told: a softmax tells units apart, an argmax does not.
TEST(NamedAttack, SeesValuesInRewards) {
  const TrainedAgent agent = untrained(recipe("dqn", 0.5, 1));
  const torch::Tensor states = torch::tensor({{1.5F, 2.5F}, {7.25F, 8.5F}});
  const double unit = agent.spec.training.reward_scale;
  ASSERT_NE(unit, 1);
  EXPECT_TRUE(torch::allclose(agent.values_in_rewards()->forward(states) * unit, agent.values()->forward(states)));
}

}  // namespace
}  // namespace maximin::deep
