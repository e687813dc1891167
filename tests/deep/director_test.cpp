#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/attacks/adaptive_director.hpp>
#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/director_training.hpp>
#include <maximin/deep/attacks/pa_ad_attack.hpp>
#include <maximin/deep/attacks/ppo.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/theory/error.hpp>

#include "lattice_values.hpp"

namespace maximin::deep {
namespace {

TEST(Ppo, AdvantagesAreAsDefined) {
  // Two lanes, three steps; the second lane's episode ends with its second step.
  const torch::Tensor rewards = torch::tensor({{1.0F, 2.0F}, {3.0F, -1.0F}, {0.5F, 4.0F}});
  const torch::Tensor values = torch::tensor({{0.1F, 0.2F}, {0.3F, 0.4F}, {0.5F, 0.6F}, {0.7F, 0.8F}});
  const torch::Tensor over = torch::tensor({{0.0F, 0.0F}, {0.0F, 1.0F}, {0.0F, 0.0F}});
  const double g = 0.9, l = 0.8;
  const torch::Tensor a = generalised_advantage(rewards, values, over, g, l);
  // The definition, a sum of discounted temporal differences up to the end.
  const double d0 = 1 + g * 0.3 - 0.1, d1 = 3 + g * 0.5 - 0.3, d2 = 0.5 + g * 0.7 - 0.5;
  EXPECT_NEAR(a[0][0].item<double>(), d0 + g * l * d1 + g * l * g * l * d2, 1e-5);
  EXPECT_NEAR(a[1][0].item<double>(), d1 + g * l * d2, 1e-5);
  EXPECT_NEAR(a[1][1].item<double>(), -1 - 0.4, 1e-5);
  EXPECT_NEAR(a[0][1].item<double>(), 2 + g * 0.4 - 0.2 + g * l * (-1 - 0.4), 1e-5);
  EXPECT_NEAR(a[2][1].item<double>(), 4 + g * 0.8 - 0.6, 1e-5);
}

/// Whether, with rewards of this sign, the policy learns which choice is right in which of four situations.
double probability_of_the_right_choice(double sign) {
  constexpr long kinds = 4, rows = 256;
  Stream rng(8);
  PpoOptions options;
  options.learning_rate = options.final_learning_rate = 3e-3;
  auto network = std::make_shared<ActorCritic>(kinds, kinds, std::vector<long>{16}, rng);
  Ppo ppo(network, options);
  torch::Tensor situation = torch::empty({rows}, torch::kLong);
  for (long i = 0; i < rows; ++i) situation[i] = rng.below(kinds);
  const torch::Tensor features = torch::one_hot(situation, kinds).to(torch::kFloat);
  const Situations situations{features, torch::zeros({rows, kinds})};
  const torch::Tensor right = (situation + 1) % kinds;
  for (int round = 0; round < 120; ++round) {
    Experience met;
    {
      torch::NoGradGuard no_grad;
      const torch::Tensor log_policy = network->log_policy(situations);
      met.choices = torch::empty({rows}, torch::kLong);
      for (long i = 0; i < rows; ++i) {
        double left = rng.uniform();
        long c = 0;
        while (c + 1 < kinds && (left -= std::exp(log_policy[i][c].item<double>())) >= 0) ++c;
        met.choices[i] = c;
      }
      met.situations = situations;
      met.log_probability = log_policy.gather(1, met.choices.unsqueeze(1)).squeeze(1);
      met.target = sign * (met.choices == right).to(torch::kFloat);
      met.advantage = met.target - network->value(features);
    }
    ppo.learn(met, 0, rng);
  }
  torch::NoGradGuard no_grad;
  return network->log_policy(situations).exp().gather(1, right.unsqueeze(1)).mean().item<double>();
}

TEST(Ppo, LearnsWhichChoiceIsRightWhere) {
  EXPECT_GT(probability_of_the_right_choice(1), 0.9);
  EXPECT_LT(probability_of_the_right_choice(-1), 0.1);
  PpoOptions bad;
  bad.clip = 0;
  EXPECT_THROW(bad.check(), InputError);
}

/// Goes left when what it sees lies in the lower half of a cell, else right. With eps 1/2 an attack has it altogether
/// in hand.
class Sleepwalker final : public GridAgent {
 public:
  void resize(Lane) override {}
  void forget(Lane) override {}
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream>,
           std::span<Action> actions) override {
    would_do(lanes, shown, actions);
  }
  void would_do(std::span<const Lane>, std::span<const Point> shown, std::span<Action> actions) const override {
    constexpr Action right = 2, left = 6;
    for (std::size_t k = 0; k < shown.size(); ++k) {
      actions[k] = shown[k].y - std::floor(shown[k].y) < 0.5 ? left : right;
    }
  }
};

/// A world where a step costs nothing: from row 5 the bomb can always be reached within 30 steps, from row 4 the gold
/// avoided, and elsewhere nothing happens. So the worst for the agent is -50 from row 5, and 0 from anywhere else.
GridworldOptions free_steps() {
  GridworldOptions options;
  options.step = 0;
  return options;
}

DirectorTraining short_training() {
  DirectorTraining training;
  training.frames = 240'000;
  training.lanes = 64;
  training.horizon = 30;
  training.stretch_frames = 40'000;
  training.ppo.learning_rate = 2e-3;
  return training;
}

AdaptiveDirectorOptions small_director() {
  AdaptiveDirectorOptions options;
  options.grid = 3;
  options.director.hidden = {32, 32};
  options.director.horizon = 30;
  return options;
}

/// Mean shortfall of the attack against the known worst, over episodes of all rows.
double regret(Director& director, const DirectorTraining& training) {
  ContinuousGridworld world(free_steps());
  Sleepwalker agent;
  EpisodesInStep episodes;
  episodes.horizon = training.horizon;
  episodes.episodes = 500;
  episodes.seed = 99;
  std::vector<double> worst(500, 0);
  const auto played = rollout_in_step(world, agent, director, episodes, [&](long k, const auto& record) {
    if (record.truth.y >= 5 && record.truth.y < 6) worst[static_cast<std::size_t>(k)] = -50;
  });
  double sum = 0;
  for (std::size_t k = 0; k < played.size(); ++k) sum += played[k].total_reward - worst[k];
  return sum / 500;
}

TEST(Director, LearnsAProblemWhoseSolutionIsKnown) {
  const ObservationBall ball(0.5);
  const ContinuousGridworld world(free_steps());
  Sleepwalker agent;
  const DirectorTraining training = short_training();
  double before = 0, after = 100;
  // An optimal attack has regret 0; one that shows anything has about 14. What 20 seeds learned was 0.7 on average and
  // 2.4 at most, and another seed may be luckier: so may another processor, which adds in another order.
  for (std::uint64_t seed = 1; seed <= 3 && after >= 3; ++seed) {
    DirectorTraining seeded = training;
    AdaptiveDirectorOptions options = small_director();
    seeded.seed = options.director.seed = seed;
    AdaptiveDirector director(nullptr, ball, options);
    before = regret(director, training);
    ASSERT_EQ(train_director(director, agent, world, seeded).size(), 7U);
    after = regret(director, training);
  }
  EXPECT_GT(before, 5);
  EXPECT_LT(after, 3);

  // Paid with the other sign, it learns to help.
  DirectorTraining flipped = training;
  flipped.pay = -training.pay;
  AdaptiveDirector ally(nullptr, ball, small_director());
  train_director(ally, agent, world, flipped);
  EXPECT_GT(regret(ally, training), before);

  // The same seed is the same director, to the last bit, and a file gives it back; another seed is another.
  DirectorTraining shorter = training;
  shorter.frames = 6'000;
  const auto trained = [&](std::uint64_t seed) {
    shorter.seed = seed;
    AdaptiveDirectorOptions options = small_director();
    options.director.seed = seed;
    auto d = std::make_unique<AdaptiveDirector>(nullptr, ball, options);
    train_director(*d, agent, world, shorter);
    return d;
  };
  const auto one = trained(5), same = trained(5), other = trained(6);
  const auto equal = [](const Director& a, const Director& b) {
    const auto p = a.network()->parameters(), r = b.network()->parameters();
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (!torch::equal(p[i], r[i])) return false;
    }
    return a.play() == b.play();
  };
  EXPECT_TRUE(equal(*one, *same));
  EXPECT_FALSE(equal(*one, *other));
  const auto path = std::filesystem::path(testing::TempDir()) / ("director_test" + std::to_string(::getpid()));
  write_tensor_file(path, one->save());
  other->load(read_tensor_file(path, "attacker"));
  EXPECT_TRUE(equal(*one, *other));
  AdaptiveDirectorOptions finer = small_director();
  finer.grid = 4;
  AdaptiveDirector another(nullptr, ball, finer);
  EXPECT_THROW(another.load(read_tensor_file(path, "attacker")), InputError);
  std::filesystem::remove(path);
}

double mean_return(GridAgent& agent, GridAttack& attack, const ObservationBall& ball) {
  ContinuousGridworld world;
  WithinBallInStep within(attack, ball);
  EpisodesInStep episodes;
  episodes.episodes = 300;
  episodes.seed = 31;
  double sum = 0;
  for (const Episode& e : rollout_in_step(world, agent, within, episodes)) sum += e.total_reward;
  return sum / 300;
}

TEST(Director, LooksFurtherAheadThanTheBestResponse) {
  const ObservationBall ball(0.2);
  const auto values = std::make_shared<LatticeValues>();
  BeliefAgent agent(values, std::make_shared<SetBeliefs>(SetBelief::exact, ball, 4), MeanAggregator{});
  AdaptiveDirectorOptions options;
  options.grid = 3;
  AdaptiveDirector director(values, ball, options);
  DirectorTraining training;
  training.frames = 60'000;
  training.stretch_frames = 20'000;
  train_director(director, agent, ContinuousGridworld(), training);
  BestResponseAttack myopic(values, ball, {3, 16});
  const double learned = mean_return(agent, director, ball), best_response = mean_return(agent, myopic, ball);
  RecordProperty("learned", std::to_string(learned));
  RecordProperty("best_response", std::to_string(best_response));
  EXPECT_LT(learned, best_response - 10);
}

}  // namespace
}  // namespace maximin::deep
