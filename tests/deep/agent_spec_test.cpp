#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <maximin/deep/agent_spec.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/trained_agent.hpp>

#include "input_errors.hpp"

namespace maximin::deep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

TEST(AgentSpec, EveryRecipeIsReadAsItIsWritten) {
  for (const std::string& kind : agent_kinds()) {
    for (const Effort& effort : {Effort(), Effort(true), Effort(false, 3000)}) {
      for (const double eps : {0.1, 0.5, 1.0 / 3}) {
        const AgentSpec spec = recipe(kind, eps, 18446744073709551615U, effort);
        const Json json = Json::parse(to_json(spec).dump());
        AgentSpec read;
        merge_json(read, json, "spec");
        EXPECT_EQ(to_json(read), json) << kind;
        EXPECT_TRUE(same_training(read, spec));
        AgentSpec same = spec;
        merge_json(same, Json::object(), "spec");
        EXPECT_EQ(to_json(same), json);
        EXPECT_EQ(spec.training.frames == 3000, effort.frames > 0);
        if (const auto first = beginning_of(spec, effort)) {
          EXPECT_EQ(first->kind, spec.start_from);
          EXPECT_EQ(first->training.seed, spec.training.seed);
          EXPECT_EQ(first->network, spec.network);
        }
      }
    }
  }
  // In small is another training of the filter, and the specification says so.
  EXPECT_FALSE(
      same_training(recipe("bp-dqn-lstm", 0.1, 1, {false, 60'000}), recipe("bp-dqn-lstm", 0.1, 1, {true, 60'000})));
  // Every field is told: each that is changed shows in the JSON.
  const AgentSpec spec = recipe("bp-dqn", 0.1, 1);
  const Json flat = to_json(spec).flatten();
  EXPECT_EQ(flat.size(), 46U + spec.network.hidden.size() - 2);
  // A loss's own options and a particle filter's are told where they count.
  EXPECT_EQ(to_json(recipe("wocar-dqn", 0.1, 1))["loss_options"].flatten().size(), 16U);
  const Json released = to_json(recipe("bp-dqn-released", 0.1, 1));
  EXPECT_EQ(released["particle_filter"]["normalisation"], "batch");
  EXPECT_EQ(released["particle_filter_belief"]["correct"], false);
  EXPECT_EQ(released["target_order"], "aggregate-of-max");
  EXPECT_EQ(released["start_anywhere"], true);
  EXPECT_FALSE(to_json(spec).contains("start_anywhere"));
  AgentSpec changed = spec;
  changed.training.replay.beta_start = 0.5;
  EXPECT_NE(to_json(changed), to_json(spec));
  EXPECT_FALSE(same_training(changed, spec));
  // A radius counts only for who knows it.
  EXPECT_TRUE(same_training(recipe("dqn", 0.1, 1), recipe("dqn", 0.5, 1)));
  EXPECT_FALSE(same_training(recipe("bp-dqn", 0.1, 1), recipe("bp-dqn", 0.5, 1)));
  EXPECT_TRUE(is_refusal(refusal([] { recipe("bp-dqm", 0.1, 1); })));
  EXPECT_NE(refusal([] { recipe("bp-dqm", 0.1, 1); }).find("expected bp-dqn"), std::string::npos);
  AgentSpec circular = recipe("dqn", 0.1, 1);
  circular.start_from = "dqn";
  EXPECT_TRUE(is_refusal(refusal([&] { beginning_of(circular); })));
}

TEST(AgentSpec, RefusesWhatIsNoSpecification) {
  const auto merge = [](const Json& json) {
    return refusal([&] {
      AgentSpec spec = recipe("bp-dqn", 0.1, 1);
      merge_json(spec, json, "mine.json");
    });
  };
  EXPECT_EQ(merge({{"eps", 1}, {"network", {{"hidden", {64, 64, 64}}}}}), "[nothing thrown]");
  EXPECT_EQ(merge({{"loss", "sa"}, {"loss_options", {{"bounds", "ibp"}}}}), "[nothing thrown]");
  EXPECT_EQ(merge({{"loss", "sa"}, {"loss_options", {{"bounds", nullptr}}}}), "[nothing thrown]");
  EXPECT_EQ(merge({{"belief", "pf-gru"}, {"particle_filter", {{"cells", false}}}}), "[nothing thrown]");
  EXPECT_EQ(merge({{"target_order", "max"}}),
            "mine.json: target_order: \"max\", expected max-of-aggregate, aggregate-of-max, belief-greedy");
  EXPECT_EQ(merge({{"epps", 1}}), "mine.json: \"epps\": no such field, expected eps");
  EXPECT_EQ(merge({{"training", {{"learning_rat", 1}}}}),
            "mine.json: training: \"learning_rat\": no such field, expected learning_rate");
  EXPECT_EQ(merge({{"training", {{"replay", {{"capacity", "9"}}}}}}),
            "mine.json: training: replay: capacity: \"9\", expected a whole number");
  const char* bad[] = {"7",
                       "[]",
                       "null",
                       "\"x\"",
                       R"({"eps": "0.1"})",
                       R"({"eps": null})",
                       R"({"eps": -0.1})",
                       R"({"eps": 5.1})",
                       R"({"kind": ""})",
                       R"({"kind": "../up"})",
                       R"({"kind": "a/b"})",
                       R"({"kind": ".hidden"})",
                       R"({"kind": "a\nb"})",
                       R"({"kind": 7})",
                       R"({"loss": "hinge"})",
                       R"({"loss": "a\u0000\n"})",
                       R"({"belief": "pf"})",
                       R"({"belief_states": 0})",
                       R"({"belief_states": 4097})",
                       R"({"belief_states": 1.5})",
                       R"({"aggregator": "max"})",
                       R"({"aggregator": "cvar:2"})",
                       R"({"double_q": 1})",
                       R"({"double_q": "true"})",
                       R"({"target_order": "max"})",
                       R"({"discount": 1.01})",
                       R"({"train_attack": "pa-ad"})",
                       R"({"start_from": "nobody"})",
                       R"({"random_actions": 2})",
                       R"({"network": []})",
                       R"({"network": {"inputs": 3}})",
                       R"({"network": {"actions": 4}})",
                       R"({"network": {"hidden": 7}})",
                       R"({"network": {"hidden": [0]}})",
                       R"({"network": {"hidden": [-1]}})",
                       R"({"network": {"hidden": [1.5]}})",
                       R"({"network": {"hidden": [65537]}})",
                       R"({"network": {"hidden": [18446744073709551615]}})",
                       R"({"network": {"hidden": [65536, 65536]}})",
                       R"({"network": {"hidden": [1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]}})",
                       R"({"network": {"waves": 17}})",
                       R"({"network": {"waves": -1}})",
                       R"({"network": {"input_scale": 1e300}})",
                       R"({"training": 7})",
                       R"({"training": {"seed": -1}})",
                       R"({"training": {"seed": 1.5}})",
                       R"({"training": {"lanes": 2147483648}})",
                       R"({"training": {"frames": 0}})",
                       R"({"training": {"frames": 9223372036854775808}})",
                       R"({"training": {"learning_rate": 0}})",
                       R"({"training": {"replay": {"alpha": -1}}})",
                       R"({"training": {"replay": {"capacity": 1e3}}})",
                       R"({"training": {"gradient_clip": -1}})",
                       R"({"particle_filter": {"cells": false}})",
                       R"({"loss_options": {"kappa": 1}})",
                       R"({"loss": "sa", "loss_options": {"kappa": -1}})",
                       R"({"loss": "sa", "loss_options": {"bounds": 2}})",
                       R"({"loss": "sa", "loss_options": {"ramp": {"end": 2}}})",
                       R"({"loss": "radial", "loss_options": {"kappa": 2}})",
                       R"({"loss": "car", "loss_options": {"lambda": 0}})",
                       R"({"loss": "wocar", "loss_options": {"critic_eps": "0.1"}})",
                       R"({"loss": "wocar", "loss_options": {"critic_eps": -1}})",
                       R"({"belief": "pf-lstm", "eps": 0})",
                       R"({"belief": "pf-lstm", "particle_filter": {"alpha": 2}})",
                       R"({"belief": "pf-lstm", "particle_filter": {"cell": "gru"}})",
                       R"({"belief": "pf-lstm", "particle_filter_training": {"batch": 0}})",
                       R"({"belief": "pf-lstm", "particle_filter_belief": {"slack": -1}})",
                       R"({"a\nb": 1})"};
  for (const char* text : bad) {
    const std::string message = merge(Json::parse(text));
    EXPECT_TRUE(is_refusal(message)) << text << message;
    EXPECT_EQ(message.rfind("mine.json: ", 0), 0U) << message;
  }
}

std::string bytes_of(const fs::path& path) {
  std::ostringstream all;
  all << std::ifstream(path, std::ios::binary).rdbuf();
  return all.str();
}

class TrainAgent : public ::testing::Test {
 protected:
  TrainAgent() { fs::remove_all(folder_); }
  ~TrainAgent() override { fs::remove_all(folder_); }

  static AgentSpec small(const std::string& kind, double eps = 0.3) {
    AgentSpec spec = recipe(kind, eps, 1, effort());
    spec.network.hidden = {16};
    return spec;
  }
  static Effort effort() { return {false, 900}; }

  /// Stops after every so many stretches and goes on, until it is done. Returns how often it was stopped.
  static int train(const AgentSpec& spec, const fs::path& folder, int stretches) {
    for (int stops = 0;; ++stops) {
      int left = stretches;
      TrainingHooks hooks;
      hooks.stretch = [&](const CurvePoint&) { return --left > 0; };
      if (train_agent(spec, folder, torch::kCPU, effort(), hooks)) return stops;
    }
  }

  fs::path folder_ = fs::path(::testing::TempDir()) / ("maximin_train_agent_test" + std::to_string(::getpid()));
};

TEST_F(TrainAgent, StoppedAndResumedLeavesTheSameFiles) {
  for (const char* kind : {"bp-dqn", "wocar-dqn", "bp-dqn-gru"}) {
    const fs::path whole = folder_ / "whole", cut = folder_ / "cut";
    AgentSpec spec = small(kind);
    spec.particle_filter.hidden = 8;
    spec.particle_filter_training.updates = 20;
    EXPECT_EQ(train(spec, whole, 1 << 30), 0);
    EXPECT_GE(train(spec, cut, 2), 3);
    for (const std::string& name : {spec.name(), std::string("dqn-seed1")}) {
      for (const char* ending : {".agent", ".csv"}) {
        EXPECT_EQ(bytes_of(whole / (name + ending)), bytes_of(cut / (name + ending))) << name << ending;
        EXPECT_FALSE(bytes_of(whole / (name + ending)).empty());
      }
      EXPECT_FALSE(fs::exists(cut / (name + ".training")));
    }
    const TrainedAgent agent = read_agent(cut / (spec.name() + ".agent"));
    EXPECT_GT(agent.training_seconds, 0);
    // It acts, whatever it acts by.
    const auto acting = make_agent(agent, acting_of(agent.spec));
    acting->resize(1);
    std::vector<Action> action{-1};
    std::vector<Stream> streams{Stream(1)};
    acting->act(std::vector<Lane>{0}, std::vector<Point>{{4.5, 4.5}}, streams, action);
    EXPECT_TRUE(action[0] >= 0 && action[0] < 8);
  }
  // The comparison tells trainings apart.
  AgentSpec other = small("bp-dqn");
  other.training.seed = 2;
  train(other, folder_ / "whole", 1 << 30);
  EXPECT_NE(bytes_of(folder_ / "whole" / "dqn-seed1.csv"), bytes_of(folder_ / "whole" / "dqn-seed2.csv"));
}

TEST(Identity, TellsApartWhatActsDifferently) {
  AgentSpec spec = recipe("bp-dqn", 0.3, 1);
  const TrainedAgent agent = untrained(spec);
  Acting acting = acting_of(spec);
  const std::string usual = identity_of(agent, acting);
  EXPECT_EQ(identity_of(untrained(spec), acting), usual);
  acting.belief_states += 1;
  EXPECT_NE(identity_of(agent, acting), usual);
  spec.belief = "pf-lstm";
  TrainedAgent with_filter = untrained(spec);
  with_filter.particle_filter = untrained_filter(spec);
  acting = acting_of(spec);
  const std::string filtered = identity_of(with_filter, acting);
  acting.filter_belief.hull_margin *= 2;
  EXPECT_NE(identity_of(with_filter, acting), filtered);
}

TEST(StartAnywhere, IsWhereEpisodesBeginAndWhatTheExactBeliefKnows) {
  for (const bool anywhere : {false, true}) {
    AgentSpec spec = recipe("bp-dqn", 0.3, 1);
    merge_json(spec, {{"start_anywhere", anywhere}}, "mine.json");
    const TrainedAgent agent = untrained(spec);
    const auto playing = make_agent(agent, acting_of(spec));
    NoAttack none;
    const AgentEvaluation e = evaluate_agent(*playing, none, ObservationBall(0.3), 400, 1, world_of(spec));
    EXPECT_EQ(e.truth_in_belief, 1);
    const ContinuousGridworld world(world_of(spec));
    bool at_an_end = false;
    for (std::uint64_t k = 0; k < 400; ++k) {
      Stream rng(1, k);
      at_an_end = at_an_end || gridworld::ends_episode(gridworld::cell(world.reset(rng)));
    }
    EXPECT_EQ(at_an_end, anywhere);
  }
  // An agent that does not know of such starts does not hold them possible.
  AgentSpec spec = recipe("bp-dqn", 0.3, 1);
  const TrainedAgent agent = untrained(spec);
  const auto playing = make_agent(agent, acting_of(spec));
  spec.start_anywhere = true;
  NoAttack none;
  EXPECT_LT(evaluate_agent(*playing, none, ObservationBall(0.3), 400, 1, world_of(spec)).truth_in_belief, 1);
}

TEST_F(TrainAgent, TakesWhatIsThereAndRefusesWhatIsNotWhatItWouldTrain) {
  const auto again = [&](const AgentSpec& spec) { return refusal([&] { train(spec, folder_, 1 << 30); }); };
  EXPECT_EQ(again(small("dqn", 0.1)), "[nothing thrown]");
  const std::string vanilla = bytes_of(folder_ / "dqn-seed1.agent");
  EXPECT_EQ(again(small("sa-dqn", 0.4)), "[nothing thrown]");  // begins with it, though its radius is another
  EXPECT_EQ(bytes_of(folder_ / "dqn-seed1.agent"), vanilla);
  AgentSpec other = small("dqn");
  other.discount = 0.9;
  EXPECT_NE(again(other).find("another specification"), std::string::npos);

  // A checkpoint that was damaged, or is of another training.
  TrainingHooks at_once;
  at_once.stretch = [](const CurvePoint&) { return false; };
  AgentSpec spec = small("dqn");
  spec.training.seed = 5;
  EXPECT_FALSE(train_agent(spec, folder_, torch::kCPU, effort(), at_once));
  const fs::path checkpoint = folder_ / "dqn-seed5.training";
  const std::string good = bytes_of(checkpoint);
  std::ofstream(checkpoint, std::ios::binary) << good.substr(0, good.size() / 2);
  EXPECT_NE(again(spec).find("checksum"), std::string::npos);
  std::ofstream(checkpoint, std::ios::binary) << good;
  other = spec;
  other.discount = 0.9;
  EXPECT_NE(again(other).find("another specification"), std::string::npos);
  EXPECT_EQ(again(spec), "[nothing thrown]");
  EXPECT_FALSE(fs::exists(checkpoint));
  // One that was left behind by a run that was killed just after it wrote the agent is cleared away.
  std::ofstream(checkpoint, std::ios::binary) << good;
  EXPECT_EQ(again(spec), "[nothing thrown]");
  EXPECT_FALSE(fs::exists(checkpoint));

  std::ofstream(folder_ / "dqn-seed5.times.json") << "[1, 2";
  EXPECT_TRUE(is_refusal(again(spec)));
  fs::remove(folder_ / "dqn-seed5.times.json");
  EXPECT_EQ(again(spec), "[nothing thrown]");
  std::ofstream(folder_ / "file") << "x";
  EXPECT_TRUE(is_refusal(refusal([&] { train(spec, folder_ / "file", 1); })));
}

}  // namespace
}  // namespace maximin::deep
