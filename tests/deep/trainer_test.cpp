#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/attacks/training_attack.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/deep/trainer.hpp>

#include "input_errors.hpp"

namespace maximin::deep {
namespace {

using torch::Tensor;

/// A training of a second or less.
AgentSpec small(const std::function<void(AgentSpec&)>& change = {}) {
  AgentSpec s;
  s.eps = 0.4;
  s.network.hidden = {16, 16};
  TrainOptions& o = s.training;
  o.frames = 800;
  o.lanes = 8;
  o.stretch_frames = 160;
  o.frames_per_update = 3;  // so that a part of an update is owed between stretches
  o.batch = 16;
  o.warm_up = 100;
  o.explore_frames = 500;
  o.target_every = 150;
  o.replay.capacity = 350;  // overwritten in the course of it
  if (change) change(s);
  return s;
}

/// A trainer with what it trains.
struct Training {
  explicit Training(const AgentSpec& spec) : agent(untrained(spec)) {
    trainer.emplace(spec.training, training_parts(agent));
  }

  TrainedAgent agent;
  std::optional<Trainer> trainer;
};

/// Everything in memory that the rest of a training depends on, through a file.
TensorFile checkpoint(const Trainer& trainer) {
  const auto path = std::filesystem::path(::testing::TempDir()) / ("maximin_trainer_test" + std::to_string(::getpid()));
  TensorFile file{"training", {}, {}};
  trainer.save(file);
  write_tensor_file(path, file);
  TensorFile read = read_tensor_file(path, "training");
  std::filesystem::remove(path);
  return read;
}

using Curve = std::vector<std::vector<std::optional<double>>>;

struct Outcomes {
  Curve curve;
  TensorFile end;
};

Outcomes uninterrupted(const AgentSpec& spec) {
  Training training(spec);
  Outcomes out;
  while (!training.trainer->done()) out.curve.push_back(training_row(training.trainer->stretch()));
  out.end = checkpoint(*training.trainer);
  return out;
}

/// The same, saved after `stretches`, destroyed, and continued from what was saved; `tamper` changes that.
Outcomes resumed(const AgentSpec& spec, int stretches, const std::function<void(TensorFile&)>& tamper = {}) {
  Outcomes out;
  TensorFile saved;
  {
    Training first(spec);
    for (int i = 0; i < stretches; ++i) out.curve.push_back(training_row(first.trainer->stretch()));
    saved = checkpoint(*first.trainer);
  }
  if (tamper) tamper(saved);
  Training second(spec);
  second.trainer->load(saved);
  while (!second.trainer->done()) out.curve.push_back(training_row(second.trainer->stretch()));
  out.end = checkpoint(*second.trainer);
  return out;
}

/// Where two trainings differ; the optimiser's own format is not compared, what it did is.
std::string difference(const Outcomes& a, const Outcomes& b) {
  if (a.curve != b.curve) return "curve";
  if (a.end.tensors.size() != b.end.tensors.size()) return "number of tensors";
  for (const auto& [name, tensor] : a.end.tensors) {
    if (name != "optimiser" && !tensor.equal(b.end.at(name))) return name;
  }
  return "";
}

TEST(Trainer, ContinuesBitForBit) {
  const AgentSpec specs[] = {
      small([](AgentSpec& s) {
        s.belief = "exact";
        s.training_belief_states = 4;
        s.aggregator = "min";
        s.double_q = false;
        s.train_attack = "mixed";
        s.training.replay.prioritised = true;
        s.training.averaged_share = 0.5;
      }),
      small([](AgentSpec& s) { s.train_attack = "pgd"; }),  // Double DQN
      small([](AgentSpec& s) { s.loss = "wocar"; }),        // further networks
      small([](AgentSpec& s) {
        s.belief = "ball";
        s.training_belief_states = 3;
        s.training.learn_from_belief = true;
        s.training.bootstrap = BootstrapBelief::current;
        s.training.truncation_is_terminal = true;
        s.training.horizon = 15;
        s.train_attack = "random";
      }),
  };
  for (const AgentSpec& spec : specs) {
    const Outcomes whole = uninterrupted(spec);
    EXPECT_EQ(whole.curve.size(), 5U);
    EXPECT_EQ(difference(whole, resumed(spec, 3)), "") << to_json(spec);
  }

  // Whatever is not carried over makes a difference.
  const AgentSpec& spec = specs[0];
  const Outcomes whole = uninterrupted(spec);
  for (const int cut : {0, 1, 4}) EXPECT_EQ(difference(whole, resumed(spec, cut)), "") << cut;
  const auto flawed = [&](const std::function<void(TensorFile&)>& tamper) {
    return difference(whole, resumed(spec, 3, tamper));
  };
  const auto change = [&](const std::string& name, double factor) {
    return flawed([&](TensorFile& file) { file.tensors[name] = file.at(name) * factor; });
  };
  EXPECT_NE(change("replay.rewards", 0), "");
  EXPECT_NE(change("replay.priorities", 0.5), "");
  EXPECT_NE(change("target.layer0.weight", 0.9), "");
  EXPECT_NE(change("owed", 0), "");
  EXPECT_NE(flawed([](TensorFile& file) { file.tensors["counters"][2] += 1; }), "");  // stretches: the streams
  EXPECT_NE(flawed([&](TensorFile& file) {
              Training fresh(spec);
              file.tensors["optimiser"] = checkpoint(*fresh.trainer).at("optimiser");
            }),
            "");
  AgentSpec other = spec;
  other.training.seed = 2;
  EXPECT_NE(difference(whole, uninterrupted(other)), "");
}

/// Weights at the end, one after another.
Tensor final_weights(double averaged_share) {
  Training training(small([&](AgentSpec& s) {
    s.training.averaged_share = averaged_share;
    s.training.target_every = 8;  // copied, and averaged, in every tick
  }));
  while (!training.trainer->done()) training.trainer->stretch();
  std::vector<Tensor> weights;
  for (const Tensor& w : training.agent.q->parameters()) weights.push_back(w.detach().flatten().clone());
  return torch::cat(weights);
}

/// The average of the last weights alone is these weights; of more it is not, but it is near.
TEST(Trainer, EndsWithTheAverageOfItsLastWeights) {
  const Tensor last = final_weights(0), of_one = final_weights(1e-9), of_some = final_weights(0.02);
  EXPECT_TRUE(torch::allclose(of_one, last, 0, 1e-6));
  EXPECT_FALSE(torch::allclose(of_some, last, 0, 1e-6));
  const Tensor first = final_weights(1);
  EXPECT_LT((of_some - last).norm().item<double>(), (first - last).norm().item<double>());
}

TEST(Trainer, RefusesCheckpointsOfOtherTrainingsAndOptionsOutOfRange) {
  Training training(small());
  for (int i = 0; i < 2; ++i) training.trainer->stretch();
  const TensorFile good = checkpoint(*training.trainer);
  const auto load = [&](const TensorFile& file, const AgentSpec& spec) {
    return refusal([&] { Training(spec).trainer->load(file); });
  };
  EXPECT_EQ(load(good, small()), "[nothing thrown]");
  EXPECT_TRUE(is_refusal(load(good, small([](AgentSpec& s) { s.network.hidden = {16, 17}; }))));
  EXPECT_TRUE(is_refusal(load(good, small([](AgentSpec& s) { s.loss = "wocar"; }))));
  EXPECT_TRUE(is_refusal(load(good, small([](AgentSpec& s) { s.training.replay.prioritised = true; }))));
  for (const auto& [name, tensor] : good.tensors) {
    TensorFile without = good, other = good;
    without.tensors.erase(name);
    other.tensors[name] = torch::zeros({2, 3, 4});
    EXPECT_TRUE(is_refusal(load(without, small()))) << name;
    EXPECT_TRUE(is_refusal(load(other, small()))) << name;
  }
  TensorFile nan = good, cut = good;
  nan.tensors["online.layer0.weight"] = good.at("online.layer0.weight") * NAN;
  cut.tensors["optimiser"] = good.at("optimiser").slice(0, 0, 100);
  EXPECT_TRUE(is_refusal(load(nan, small())));
  EXPECT_TRUE(is_refusal(load(cut, small())));

  const std::function<void(TrainOptions&)> bad[] = {
      [](TrainOptions& o) { o.frames = 0; },          [](TrainOptions& o) { o.lanes = 0; },
      [](TrainOptions& o) { o.lanes = 5000; },        [](TrainOptions& o) { o.horizon = 0; },
      [](TrainOptions& o) { o.batch = 0; },           [](TrainOptions& o) { o.batch = 1L << 40; },
      [](TrainOptions& o) { o.learning_rate = 0; },   [](TrainOptions& o) { o.learning_rate = NAN; },
      [](TrainOptions& o) { o.gradient_clip = 0; },   [](TrainOptions& o) { o.gradient_clip = -1; },
      [](TrainOptions& o) { o.adam_eps = -1; },       [](TrainOptions& o) { o.warm_up = -1; },
      [](TrainOptions& o) { o.explore_start = 1.1; }, [](TrainOptions& o) { o.explore_end = -0.1; },
      [](TrainOptions& o) { o.target_every = 0; },    [](TrainOptions& o) { o.reward_scale = 0; },
      [](TrainOptions& o) { o.stretch_frames = 7; },  [](TrainOptions& o) { o.final_learning_rate = -1; },
      [](TrainOptions& o) { o.replay.capacity = 0; }, [](TrainOptions& o) { o.frames_per_update = 0; },
  };
  for (std::size_t i = 0; i < std::size(bad); ++i) {
    EXPECT_TRUE(is_refusal(refusal([&] { Training(small([&](AgentSpec& s) { bad[i](s.training); })); }))) << i;
  }
}

/// The replay memory after a training at random, without updates, of the same episodes whatever the options.
TensorFile memory(const std::function<void(AgentSpec&)>& change) {
  Training training(small([&](AgentSpec& s) {
    s.training.frames = 1600;
    s.training.stretch_frames = 320;
    s.training.warm_up = 1 << 30;
    s.training.explore_end = 1;
    s.training.replay.capacity = 5000;
    s.training.horizon = 20;
    change(s);
  }));
  while (!training.trainer->done()) training.trainer->stretch();
  return checkpoint(*training.trainer);
}

/// Shares of all transitions that are ends, that lead where their action does, and whose belief is near a place.
struct Memory {
  double terminal = 0, unlike_world = 0, belief_at_next = 0, belief_at_state = 0, belief_mean_is_next = 0;
  long size = 0, entered = 0;
};

Memory study(const TensorFile& file, double eps) {
  const auto places = [&](const char* name) { return file.at(std::string("replay.") + name).to(torch::kDouble); };
  const Tensor states = places("states"), next = places("next_states"), terminal = places("terminal");
  const Tensor beliefs = places("beliefs"), weights = places("belief_weights"), actions = file.at("replay.actions");
  const ContinuousGridworld world;
  Memory m;
  m.size = states.size(0);
  long going_on = 0;
  for (long i = 0; i < m.size; ++i) {
    const bool over = terminal[i].item<double>() == 1;
    const Outcome<Point> outcome = world.step({states[i][0].item<double>(), states[i][1].item<double>()},
                                              static_cast<Action>(actions[i].item<long>()));
    const Tensor wanted = torch::tensor({outcome.next.x, outcome.next.y}, torch::kDouble);
    const bool at_an_edge = (wanted - wanted.round()).abs().min().item<double>() < 1e-4;  // floats cannot say
    m.unlike_world += !at_an_edge && (!torch::allclose(next[i], wanted, 0, 1e-5) || (outcome.terminal && !over));
    m.entered += outcome.terminal;
    m.terminal += over;
    if (over) continue;
    ++going_on;
    const auto within = [&](const Tensor& place) {
      return (beliefs[i] - place).abs().max().item<double>() < eps + 1e-5;
    };
    m.belief_at_next += within(next[i]);
    m.belief_at_state += within(states[i]);
    m.belief_mean_is_next += torch::allclose((beliefs[i] * weights[i].unsqueeze(1)).sum(0), next[i], 0, 1e-5);
  }
  for (double* share : {&m.terminal, &m.unlike_world}) *share /= static_cast<double>(m.size);
  for (double* share : {&m.belief_at_next, &m.belief_at_state, &m.belief_mean_is_next}) {
    *share /= static_cast<double>(going_on);
  }
  return m;
}

TEST(Trainer, RefusesANetworkOfOtherActionsThanTheWorlds) {
  const AgentSpec spec = recipe("dqn", 0.2, 1);
  TrainedAgent agent = untrained(spec);
  TrainingParts parts = training_parts(agent);
  EXPECT_NO_THROW(Trainer(spec.training, parts));
  QNetworkShape shape;
  shape.actions = 4;
  Stream rng(1);
  parts.online = std::make_shared<QNetwork>(shape, rng);
  EXPECT_THROW(Trainer(spec.training, parts), InputError);
}

TEST(Trainer, StoresWhatHappened) {
  const auto ball = [](AgentSpec& s) {
    s.eps = 0.2;
    s.belief = "ball";
    s.training_belief_states = 4;
  };
  // A cut by the horizon is no end: what was cut goes on to the place that it led to, and is bootstrapped.
  const Memory usual = study(memory(ball), 0.2);
  EXPECT_EQ(usual.size, 1600);
  EXPECT_EQ(usual.unlike_world, 0);
  EXPECT_NEAR(usual.terminal * 1600, static_cast<double>(usual.entered), 3);
  EXPECT_EQ(usual.belief_at_next, 1);
  EXPECT_LT(usual.belief_at_state, 0.5);
  EXPECT_LT(usual.belief_mean_is_next, 0.5);

  // As the paper's runs had it, it is one: 1,600 frames of at most 20 steps are at least 80 episodes, less those that
  // go on at the end of a stretch.
  const Memory cut = study(memory([&](AgentSpec& s) {
                             ball(s);
                             s.training.truncation_is_terminal = true;
                           }),
                           0.2);
  EXPECT_GE(cut.terminal * 1600 - static_cast<double>(cut.entered), 60);
  EXPECT_EQ(cut.unlike_world, 0);

  // M_t, as Algorithm 4 prints it, in place of M_{t+1}.
  const Memory stale = study(memory([&](AgentSpec& s) {
                               ball(s);
                               s.training.bootstrap = BootstrapBelief::current;
                             }),
                             0.2);
  EXPECT_EQ(stale.belief_at_state, 1);
  EXPECT_LT(stale.belief_at_next, 0.5);
  EXPECT_EQ(stale.unlike_world, 0);

  // In the noisy environment the learner is told the mean of what is believed for the state.
  const Memory noisy = study(memory([&](AgentSpec& s) {
                               ball(s);
                               s.training.learn_from_belief = true;
                               s.train_attack = "random";
                             }),
                             0.2);
  EXPECT_EQ(noisy.belief_mean_is_next, 1);
  EXPECT_GT(noisy.unlike_world, 0.5);

  // Updates are due from the first frame on, when nothing is remembered yet.
  Training eager(small([](AgentSpec& s) { s.training.warm_up = 0; }));
  EXPECT_GT(eager.trainer->stretch().updates, 0);
  // A training that runs away says so.
  EXPECT_TRUE(is_refusal(refusal([] {
    Training wild(small([](AgentSpec& s) { s.training.learning_rate = s.training.final_learning_rate = 1e30; }));
    while (!wild.trainer->done()) wild.trainer->stretch();
  })));
}

double clean_return(const AgentSpec& spec) {
  Training training(spec);
  while (!training.trainer->done()) training.trainer->stretch();
  BeliefAgent agent(training.agent.values(), std::make_shared<ObservedState>(), MeanAggregator{}, 0.05);
  NoAttack attack;
  const AgentEvaluation e = evaluate_agent(agent, attack, ObservationBall(0), 100, 5);
  double sum = 0;
  for (const double r : e.returns) sum += r;
  return sum / 100;
}

TEST(Trainer, LearnsTheGridworld) {
  AgentSpec spec = recipe("dqn", 0.1, 1, Effort(false, 40'000));
  spec.network.hidden = {64, 64};
  spec.discount = 0.95;  // a shorter view is learned sooner
  TrainOptions& o = spec.training;
  o.lanes = 32;
  o.learning_rate = 3e-3;
  o.explore_frames = o.frames;
  o.explore_end = 0.3;
  o.target_every = 300;
  o.frames_per_update = 8;
  EXPECT_GT(clean_return(spec), 0);  // about 100; random: -76, wandering: -100, the best: 188
  // Where nothing is learned, however long is long enough.
  o.learning_rate = o.final_learning_rate = 1e-12;
  o.frames = 4000;
  EXPECT_LT(clean_return(spec), -40);
}

}  // namespace
}  // namespace maximin::deep
