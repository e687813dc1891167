#include <gtest/gtest.h>
#include <unistd.h>
#include <string>

#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <vector>

#include <maximin/deep/replay.hpp>

#include "input_errors.hpp"

namespace maximin::deep::replay_test {  // of its own: built as one unit with its neighbours
namespace {

using torch::Tensor;

constexpr long states = 3;

/// Transition number i, which can be told from all others; every fourth ends its episode.
Transition transition(long i) {
  const double x = static_cast<double>(i);
  return {{x, x + 0.5}, static_cast<Action>(i % 8), 10 * x, {x + 0.25, x + 0.75}, i % 4 == 3};
}

BeliefStates belief(long i) {
  const Tensor weights = torch::tensor({0.5F, 0.25F, 0.25F}).unsqueeze(0).repeat({2, 1});
  const Tensor places =
      torch::arange(2 * 2 * states, torch::kFloat).view({2, states, 2}) + 100 * static_cast<double>(i);
  return {places, weights};
}

Replay filled(const ReplayOptions& options, long n) {
  Replay replay(options, states);
  for (long i = 0; i < n; ++i) replay.add(transition(i), belief(i), i % 2);
  return replay;
}

ReplayOptions options(long capacity, bool prioritised) {
  ReplayOptions o;
  o.capacity = capacity;
  o.prioritised = prioritised;
  return o;
}

/// How far the frequencies of many draws are from these shares: chi square, 1 degree of freedom less than shares.
double chi_square(const Replay& replay, const std::vector<double>& shares) {
  Stream rng(7);
  std::vector<double> counts(shares.size());
  constexpr int draws = 300, batch = 64;
  for (int d = 0; d < draws; ++d) {
    for (const long i : replay.draw(batch, 0.5, rng, torch::kCPU).indices) ++counts.at(static_cast<std::size_t>(i));
  }
  double sum = 0, distance = 0;
  for (const double s : shares) sum += s;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double expected = draws * batch * shares[i] / sum;
    distance += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  return distance;
}

/// A memory of 12 of 13 whose transition i was wrong by i + 1, and the shares with which it must be drawn.
Replay reprioritised() {
  Replay replay = filled(options(13, true), 12);
  std::vector<long> indices;
  for (long i = 0; i < 12; ++i) indices.push_back(i);
  replay.reprioritise(indices, torch::arange(1, 13, torch::kFloat) * torch::tensor({-1.0F, 1.0F}).repeat({6}));
  return replay;
}
std::vector<double> shares_to_the(double alpha) {
  std::vector<double> shares;
  for (int i = 0; i < 12; ++i) shares.push_back(std::pow(i + 1 + 1e-6, alpha));
  return shares;
}

TEST(Replay, DrawsAsOftenAsItShouldWithImportanceByDefinition) {
  constexpr double likely = 31.3;  // 11 degrees of freedom, 1 in 1,000
  const std::vector<double> equal(12, 1.0);
  EXPECT_LT(chi_square(filled(options(13, false), 12), equal), likely);
  EXPECT_LT(chi_square(filled(options(13, true), 12), equal), likely);  // all new, all alike
  const Replay replay = reprioritised();
  EXPECT_LT(chi_square(replay, shares_to_the(0.5)), likely);
  // Other shares are told apart.
  EXPECT_GT(chi_square(replay, equal), 10 * likely);
  EXPECT_GT(chi_square(replay, shares_to_the(0.6)), likely);
  std::vector<double> two_swapped = equal;
  two_swapped[4] = 1.2;
  EXPECT_GT(chi_square(filled(options(13, false), 12), two_swapped), likely);

  // (N p)^-beta over its greatest in the batch (Schaul et al. 2016); beta goes from 0.4 to 1.
  const std::vector<double> p = shares_to_the(0.5);
  double sum = 0;
  for (const double s : p) sum += s;
  for (const double progress : {0.0, 0.25, 1.0, 3.0}) {
    Stream rng(3);
    const Replay::Draw draw = replay.draw(32, progress, rng, torch::kCPU);
    const auto error = [&](double beta) {
      double greatest = 0, worst = 0;
      const auto weight = [&](long i) { return std::pow(12 * p[static_cast<std::size_t>(i)] / sum, -beta); };
      for (const long i : draw.indices) greatest = std::max(greatest, weight(i));
      for (std::size_t j = 0; j < 32; ++j) {
        const double got = draw.importance[static_cast<long>(j)].item<double>();
        worst = std::max(worst, std::abs(got - weight(draw.indices[j]) / greatest));
      }
      return worst;
    };
    const double beta = 0.4 + 0.6 * std::min(progress, 1.0);
    EXPECT_LT(error(beta), 1e-6);
    EXPECT_GT(error(beta + 0.1), 1e-3);
  }
  Stream rng(1);
  EXPECT_TRUE(filled(options(13, false), 12).draw(8, 0, rng, torch::kCPU).importance.equal(torch::ones({8})));
}

/// What is wrong with a drawn batch, given which transition stands at each index.
std::string flaw_of(const Replay::Draw& draw, const std::function<long(long)>& number_at) {
  const Batch& b = draw.batch;
  for (std::size_t j = 0; j < draw.indices.size(); ++j) {
    const long row = static_cast<long>(j), i = number_at(draw.indices[j]);
    const Transition t = transition(i);
    const auto place = [](Point p) { return torch::tensor({static_cast<float>(p.x), static_cast<float>(p.y)}); };
    if (!b.states[row].equal(place(t.state))) return "state";
    if (!b.next_states[row].equal(place(t.next))) return "next state";
    if (b.actions[row].item<long>() != t.action) return "action";
    if (b.rewards[row].item<double>() != t.reward) return "reward";
    if ((b.terminal[row].item<double>() == 1) != t.terminal) return "terminal";
    const BeliefStates m = belief(i);
    if (!t.terminal && !b.next_belief.states[row].equal(m.states[i % 2])) return "belief";
    if (!t.terminal && !b.next_belief.weights[row].equal(m.weights[0])) return "weights";
    if (t.terminal && !b.next_belief.states.isfinite().all().item<bool>()) return "belief of an end";
  }
  return "";
}

TEST(Replay, KeepsTheLastTransitionsAsTheyWere) {
  for (const bool prioritised : {false, true}) {
    const Replay replay = filled(options(5, prioritised), 8);
    EXPECT_EQ(replay.size(), 5);
    Stream rng(4);
    const Replay::Draw draw = replay.draw(200, 1, rng, torch::kCPU);
    EXPECT_EQ(std::set<long>(draw.indices.begin(), draw.indices.end()).size(), 5U);
    EXPECT_EQ(flaw_of(draw, [](long i) { return i < 3 ? i + 5 : i; }), "");
    EXPECT_NE(flaw_of(draw, [](long i) { return i; }), "");  // as if nothing had been overwritten
  }
}

class ReplayFile : public ::testing::Test {
 protected:
  TensorFile saved(const Replay& replay) const {
    TensorFile file{"replay", {}, {}};
    replay.save(file);
    write_tensor_file(path_, file);
    return read_tensor_file(path_, "replay");
  }
  ~ReplayFile() override { std::filesystem::remove(path_); }

  std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) / ("maximin_replay_test" + std::to_string(::getpid()));
};

/// Whether the two memories go on alike.
bool alike(Replay& a, Replay& b) {
  Stream one(9), other(9);
  for (long i = 20; i < 40; ++i) {
    const Replay::Draw x = a.draw(16, 0.3, one, torch::kCPU), y = b.draw(16, 0.3, other, torch::kCPU);
    if (x.indices != y.indices || !x.importance.equal(y.importance)) return false;
    if (!x.batch.states.equal(y.batch.states) || !x.batch.next_belief.states.equal(y.batch.next_belief.states))
      return false;
    a.reprioritise(x.indices, x.batch.rewards + 1);
    b.reprioritise(y.indices, y.batch.rewards + 1);
    a.add(transition(i), belief(i), 0);
    b.add(transition(i), belief(i), 0);
  }
  return true;
}

TEST_F(ReplayFile, IsTheSameMemoryAgain) {
  for (const long n : {1L, 12L, 13L, 17L}) {
    for (const bool prioritised : {false, true}) {
      Replay replay = filled(options(13, prioritised), n);
      replay.reprioritise({0}, torch::tensor({50.0F}));
      Replay again(options(13, prioritised), states);
      again.load(saved(replay));
      EXPECT_EQ(again.size(), replay.size());
      EXPECT_TRUE(alike(replay, again)) << n;
    }
  }
  // The same transitions with other priorities do not go on alike.
  Replay wrong = filled(options(13, true), 12), right = reprioritised();
  EXPECT_FALSE(alike(wrong, right));
}

TEST_F(ReplayFile, RefusesWhatDoesNotFit) {
  const TensorFile good = saved(reprioritised());
  const auto load = [](const TensorFile& file, long capacity = 13, long k = states, bool prioritised = true) {
    return refusal([&] { Replay(options(capacity, prioritised), k).load(file); });
  };
  EXPECT_EQ(load(good), "[nothing thrown]");
  EXPECT_TRUE(is_refusal(load(good, 5)));
  EXPECT_TRUE(is_refusal(load(good, 13, 4)));
  EXPECT_TRUE(is_refusal(load(good, 20)) == false);  // a greater memory goes on behind the last
  for (const auto& [name, tensor] : good.tensors) {
    TensorFile without = good, other = good;
    without.tensors.erase(name);
    other.tensors[name] = torch::zeros({1, 1, 1});
    EXPECT_TRUE(is_refusal(load(without))) << name;
    EXPECT_TRUE(is_refusal(load(other))) << name;
  }
  const auto with = [&](const char* name, const Tensor& tensor) {
    TensorFile file = good;
    file.tensors[name] = tensor;
    return load(file);
  };
  for (const auto& counters : std::vector<std::vector<long>>{{12, 3}, {14, 1}, {-1, 0}, {12, 13}, {12, -1}, {0, 5}}) {
    EXPECT_TRUE(is_refusal(with("replay.counters", torch::tensor(counters)))) << counters[0] << ' ' << counters[1];
  }
  EXPECT_TRUE(is_refusal(with("replay.actions", torch::full({12}, 8, torch::kLong))));
  EXPECT_TRUE(is_refusal(with("replay.actions", torch::full({12}, -1, torch::kLong))));
  for (const double priority : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_TRUE(is_refusal(with("replay.priorities", torch::full({12}, priority, torch::kDouble)))) << priority;
    EXPECT_TRUE(is_refusal(with("replay.largest", torch::full({1}, priority, torch::kDouble)))) << priority;
  }

  ReplayOptions bad[] = {options(0, false), options(-1, false), options(20'000'000, false), {}, {}, {}};
  bad[3].alpha = -0.1;
  bad[4].alpha = NAN;
  bad[5].beta_start = 1.5;
  for (const ReplayOptions& o : bad) EXPECT_TRUE(is_refusal(refusal([&] { Replay(o, states); })));
  EXPECT_TRUE(is_refusal(refusal([&] { Replay(options(10'000'000, false), 4096); })));
}

}  // namespace
}  // namespace maximin::deep::replay_test
