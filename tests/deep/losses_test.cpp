#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <maximin/deep/losses/car_loss.hpp>
#include <maximin/deep/losses/radial_loss.hpp>
#include <maximin/deep/losses/sa_loss.hpp>
#include <maximin/deep/losses/td_loss.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/theory/error.hpp>

#include "tiny_networks.hpp"

namespace maximin::deep {
namespace {

using torch::Tensor;

constexpr Progress kEnd{1};

Tensor row(std::vector<double> numbers) {
  return torch::tensor(numbers, torch::kDouble);
}

double number(const Tensor& t) {
  return t.item<double>();
}

// One transition each of: state 0, action 0, reward 1 to state 2; the same as an end; state 1, action 1, reward -1 to
// 0.
Batch three_transitions() {
  return {row({0, 0, 1}).unsqueeze(1),
          torch::tensor({0, 0, 1}, torch::kLong),
          row({1, 1, -1}),
          row({0, 1, 0}),
          row({2, 2, 0}).unsqueeze(1),
          {}};
}

// Q(x) = (x + 1, 2 - x) without a hidden layer, so that every bound is exact; Q'(x) = (x, 3 - 2x).
struct Affine {
  QNetworkPtr online = network_of({{{{1}, {-1}}, {1, 2}}});
  QNetworkPtr target = network_of({{{{1}, {-2}}, {0, 3}}});
};

PerturbationRamp full(double eps) {
  PerturbationRamp ramp;
  ramp.eps = eps;
  ramp.range = {-10, 10};
  return ramp;
}

void expect_values(const Tensor& got, const std::vector<double>& wanted, double tolerance = 1e-12) {
  EXPECT_TRUE(torch::allclose(got.detach(), row(wanted), 0, tolerance)) << got;
}

double huber_of(double e) {
  return std::abs(e) <= 1 ? e * e / 2 : std::abs(e) - 0.5;
}

TEST(TdError, HandComputed) {
  const Batch batch = three_transitions();
  Affine q;
  // Q(2) = (3, 0), Q'(2) = (2, -1); Q(0) = (1, 2), Q'(0) = (0, 3): both ways choose alike.
  TdOptions td{.discount = 0.5};
  expect_values(next_state_target(batch, *q.online, *q.target, td), {2, 1, 0.5});
  // With Q'(x) = (0, x) the target network prefers action 1 in state 2, and the online network action 0.
  const auto other = network_of({{{{0}, {1}}, {0, 0}}});
  expect_values(next_state_target(batch, *q.online, *other, td), {1, 1, -1});
  td.double_q = false;
  expect_values(next_state_target(batch, *q.online, *other, td), {2, 1, -1});
  expect_values(huber(row({0.5, -1, 3}), 1), {0.125, 0.5, 2.5});
  expect_values(huber(row({0.5, -1, 3}), 2), {0.125, 0.5, 4});
  EXPECT_FALSE(next_state_target(batch, *q.online, *q.target, td).requires_grad());
}

TEST(TdLoss, OrdersOfBestActionAndWorstState) {
  // Q'(x) = (x, 3 - 2x). Beliefs of three transitions: {0, 2}, {2, 2}, {1, 0}; Q'(0) = (0, 3), Q'(1) = (1, 1),
  // Q'(2) = (2, -1).
  Batch batch = three_transitions();
  batch.next_belief = {torch::tensor({0., 2., 2., 2., 1., 0.}, torch::kDouble).view({3, 2, 1}),
                       torch::full({3, 2}, 0.5, torch::kDouble)};
  Affine q;
  TdLossOptions options{.td = {.discount = 0.5, .double_q = false}};
  const auto targets = [&] { return TdLoss(options).target_values(batch, *q.online, *q.target); };
  // max_a min_m: max(0, -1) = 0; an end; max(0, 1) = 1.
  expect_values(targets(), {1, 1, -1 + 0.5});
  // min_m max_a: min(3, 2) = 2; an end; min(1, 3) = 1.
  options.order = TargetOrder::aggregate_of_max;
  expect_values(targets(), {1 + 1, 1, -1 + 0.5});
  // What is greedy at 0 (action 1) and at 2 (action 0), done in 2: min(-1, 2) = -1; what is at 1 (0 or 1, the first)
  // and at 0 (action 1), done in 0: min(0, 3) = 0.
  options.order = TargetOrder::belief_greedy;
  expect_values(targets(), {1 - 0.5, 1, -1});
  options.aggregator = MeanAggregator{};
  expect_values(targets(), {1 + 0.25, 1, -1 + 0.75});
}

TEST(PerturbationRamp, GrowsFromNothingToFull) {
  PerturbationRamp ramp{.eps = 0.5, .start = 0.2, .end = 0.6};
  for (const auto& [fraction, share] :
       std::vector<std::pair<double, double>>{{0, 0}, {.2, 0}, {.3, .25}, {.6, 1}, {1, 1}}) {
    EXPECT_NEAR(ramp.share({fraction}), share, 1e-12);
    EXPECT_NEAR(ramp.eps_at({fraction}), share / 2, 1e-12);
  }
  ramp.shape = PerturbationRamp::Shape::smoothed;
  double before = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double now = ramp.share({i / 1000.});
    EXPECT_GE(now, before);
    EXPECT_LT(now - before, 0.0035);  // no jump; the slope is at most 1.23 / 0.4
    before = now;
  }
  EXPECT_EQ(before, 1);
  // m^4 / (m^4 + 4 m^3 (1 - m)) with m = 1/4.
  EXPECT_NEAR(ramp.share({0.3}), 1. / 13, 1e-12);
  EXPECT_EQ((PerturbationRamp{.start = 0, .end = 0}).share({0}), 1);
}

TEST(SaLoss, HandComputed) {
  const Batch batch = three_transitions();
  Affine q;
  // Q_1 - Q_0 = 1 - 2x. In 0 action 1 leads by 1: within 0.2 of it action 0 leads by at most -1 + 0.4. In 1, where
  // action 0 leads by 1, likewise.
  SaLossOptions options{.td = {.discount = 0.5}, .ramp = full(0.2), .kappa = 0.1, .margin = 1};
  const auto hinge = [&](const Progress& progress = kEnd) {
    return SaLoss(options).hinge(batch.states, *q.online, progress);
  };
  expect_values(hinge(), {-0.6, -0.6, -0.6});
  // Errors 2 - 1, 1 - 1 and 1/2 - 1.
  const LossValue value = SaLoss(options)(batch, *q.online, *q.target, kEnd);
  expect_values(value.loss, {0.5 - 0.06, 0 - 0.06, 0.125 - 0.06});
  expect_values(value.td_error, {1, 0, -0.5});
  EXPECT_FALSE(value.td_error.requires_grad());
  options.ramp.eps = 0.75;  // now the other action can lead
  expect_values(hinge(), {0.5, 0.5, 0.5});
  options.ramp.end = 1;  // half way up the ramp, radius 0.375
  expect_values(hinge({0.5}), {-0.25, -0.25, -0.25});
  options.margin = 0.1;
  expect_values(hinge({0.5}), {-0.1, -0.1, -0.1});
  // The control: the opposite difference would say otherwise.
  EXPECT_GT(number(difference_upper_bounds(*q.online, options.ramp.ball(batch.states, kEnd),
                                           torch::tensor({0, 0, 1}, torch::kLong), BoundMethod::ibp)
                       .amax()),
            2);
}

// The bound of the mixture, half way: half CROWN-IBP and half IBP.
TEST(SaLoss, MixesBoundsAlongTheRamp) {
  Stream rng(11);
  const auto q = random_network({.inputs = 2, .hidden = {8, 8}, .actions = 3}, rng, torch::kDouble);
  const Tensor states = random_points(20, 2, 0, 10, rng);
  SaLossOptions options;
  options.margin = 100;
  options.ramp = PerturbationRamp{.eps = 1, .start = 0, .end = 1};
  const Tensor greedy = q->forward(states).argmax(1);
  const StateBox half = ball_around(states, 0.5);
  const Tensor linear = difference_upper_bounds(*q, half, greedy, BoundMethod::crown_ibp);
  const Tensor intervals = difference_upper_bounds(*q, half, greedy, BoundMethod::ibp);
  const Tensor mixed = SaLoss(options).hinge(states, *q, {0.5});
  EXPECT_TRUE(torch::allclose(mixed, greatest_lead((linear + intervals) / 2, greedy)));
  EXPECT_FALSE(torch::allclose(mixed, greatest_lead(linear, greedy)));
  options.bounds = BoundMethod::ibp;
  EXPECT_TRUE(torch::allclose(SaLoss(options).hinge(states, *q, {0.5}), greatest_lead(intervals, greedy)));
}

// How many of 8 states provably keep their greedy action in a ball, by a hinge that is not above 0, and how many of
// those nevertheless change it somewhere in the ball of radius eps. The hinge is asked for radius `believed`.
struct Kept {
  long free = 0, wrong = 0, changed = 0;
};
Kept count_kept(Stream& rng, double eps, double believed) {
  torch::NoGradGuard no_grad;
  const auto q = random_network({.inputs = 2, .hidden = {8, 8}, .actions = 3}, rng, torch::kFloat, 2);
  SaLossOptions options;
  options.margin = 0;
  options.ramp = PerturbationRamp{.eps = 2 * believed, .start = 0, .end = 1};
  const Tensor states = random_points(8, 2, 0, 10, rng, torch::kFloat);
  const Tensor free = SaLoss(options).hinge(states, *q, {0.5}) <= 0;
  const StateBox ball = ball_around(states, eps);
  const Tensor greedy = q->forward(states).argmax(1);
  Tensor changed = torch::zeros_like(free);
  for (int i = 0; i < 20; ++i) {
    Tensor t = random_points(8, 2, 0, 1, rng, torch::kFloat);
    if (i % 2 == 0) t = t.round();
    const Tensor x = torch::minimum(torch::maximum(ball.low + t * (ball.high - ball.low), ball.low), ball.high);
    changed = torch::logical_or(changed, q->forward(x).argmax(1) != greedy);
  }
  const auto count = [](const Tensor& t) { return t.sum().item<long>(); };
  return {count(free), count(torch::logical_and(free, changed)), count(changed)};
}

RC_GTEST_PROP(SaLoss, NoPenaltyOnlyWhereTheActionProvablyStays, (std::uint64_t seed)) {
  Stream rng(seed);
  const double eps = rng.uniform(0, 0.5);
  const Kept kept = count_kept(rng, eps, eps);
  RC_ASSERT(kept.wrong == 0);
  RC_CLASSIFY(kept.free > 0, "some action provably stays");
}

TEST(SaLoss, TheSamplingCheckSeesBoundsOfASmallerBall) {
  Kept right, wrong;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    for (const bool faulty : {false, true}) {
      Stream rng(seed);
      const Kept kept = count_kept(rng, 0.5, faulty ? 0.1 : 0.5);
      Kept& sum = faulty ? wrong : right;
      sum = {sum.free + kept.free, sum.wrong + kept.wrong, sum.changed + kept.changed};
    }
  }
  EXPECT_GT(right.free, 50);
  EXPECT_GT(right.changed, 50);
  EXPECT_EQ(right.wrong, 0);
  EXPECT_GT(wrong.wrong, 20);
}

TEST(RadialLoss, HandComputed) {
  const Batch batch = three_transitions();
  // Q(x) = (3 + x, 2 - x): in 0 action 0 is taken and better by 1; in 1 action 1 is taken and worse, which costs
  // nothing.
  const auto online = network_of({{{{1}, {-1}}, {3, 2}}});
  RadialLossOptions options;
  options.td.discount = 0.5;
  options.ramp = full(0.4);
  const auto adversarial = [&] {
    return RadialLoss(options).adversarial(batch, online->forward(batch.states), *online, kEnd);
  };
  // upper(1) - lower(0) + 1/2 = 2.4 - 2.6 + 0.5; for the taken action d = 0.
  expect_values(adversarial(), {0.3, 0.3, 0});
  options.overlap = RadialOverlap::merged_difference;  // Q_1 - Q_0 = -1 - 2x: the same here
  expect_values(adversarial(), {0.3, 0.3, 0});
  options.ramp = full(0.2);  // 2.2 - 2.8 + 0.5 < 0
  expect_values(adversarial(), {0, 0, 0});

  options.ramp = full(0.4);
  Affine q;
  // y = 1 + Q'(2)_0 / 2 = 2, 1, and -1 + Q'(0)_0 / 2 = -1, as Q(0) = (3, 2) chooses action 0; errors -1, -2, -2.
  const LossValue value = RadialLoss(options)(batch, *online, *q.target, kEnd);
  expect_values(value.loss, {0.8 * 0.5 + 0.2 * 0.3, 0.8 * 1.5 + 0.2 * 0.3, 0.8 * 1.5});
  expect_values(value.td_error, {-1, -2, -2});
  options.ramp_kappa = true;
  options.ramp.end = 1;
  options.ramp.eps = 0.8;
  expect_values(RadialLoss(options)(batch, *online, *q.target, {0.5}).loss,
                {0.9 * 0.5 + 0.1 * 0.3, 0.9 * 1.5 + 0.1 * 0.3, 0.9 * 1.5});
}

TEST(CarLoss, HandComputed) {
  const Batch batch = three_transitions();
  Affine q;
  CarLossOptions options;
  options.td.discount = 0.5;
  options.ramp = full(0.2);
  // y = 2, 1, 0.5; Q(s,a) = 1, 1, 1, each +- 0.2: e = 1.2, 0.2, 0.7.
  const std::array e{1.2, 0.2, 0.7};
  const auto expected = [&](double lambda, const std::function<double(double)>& score) {
    double sum = 0;
    for (const double x : e) sum += std::exp(score(x) / lambda);
    std::vector<double> list;
    for (const double x : e) list.push_back(3 * std::exp(score(x) / lambda) / sum * huber_of(x));
    return list;
  };
  const auto loss = [&] { return CarLoss(options)(batch, *q.online, *q.target, kEnd).loss; };
  const auto itself = [](double x) { return x; };
  expect_values(loss(), expected(1, itself));
  options.lambda = 0.3;
  expect_values(loss(), expected(0.3, itself));
  options.weights = CarWeights::huber;
  expect_values(loss(), expected(0.3, huber_of));
  EXPECT_FALSE(torch::allclose(loss().detach(), row(expected(0.3, itself)), 0, 1e-3)) << "a control";
  options.lambda = 1e-3;  // the largest error alone
  EXPECT_NEAR(number(loss().mean()), huber_of(1.2), 1e-12);
  options.lambda = 1e9;
  EXPECT_NEAR(number(loss().mean()), (huber_of(1.2) + huber_of(0.2) + huber_of(0.7)) / 3, 1e-8);
  options.clean_share = 1;
  expect_values(loss(), {0.5, 0, 0.125});
  expect_values(CarLoss(options)(batch, *q.online, *q.target, kEnd).td_error, {1, 0, -0.5});
}

// A WocaR loss whose critic and its target network are given affine functions.
std::unique_ptr<WocarLoss> wocar(const WocarLossOptions& options, const QNetwork& critic, const QNetwork& target) {
  Stream rng(0);
  auto loss = std::make_unique<WocarLoss>(options, critic.shape(), rng);
  for (const auto& module : loss->modules()) module->to(torch::kDouble);
  loss->critic().copy_from(critic);
  loss->critic_target().copy_from(target);
  return loss;
}

TEST(WocarLoss, HandComputed) {
  const Batch batch = three_transitions();
  Affine q;
  const auto critic = network_of({{{{0}, {0}}, {-2, -5}}});
  const auto critic_target = network_of({{{{1}, {1}}, {-3, -7}}});
  WocarLossOptions options;
  options.td.discount = 0.5;
  options.worst_share = 0.1;
  options.robust_term = WocarRobustTerm::none;
  options.reach_of_acting_values = false;
  options.ramp = full(0.2);
  const auto make = [&] { return wocar(options, *critic, *critic_target); };
  // Q_1 - Q_0 = 1 - 2x is of one sign within 0.2 of 2 (action 0) and of 0 (action 1), so the critic's targets are
  // 1 + (2-3)/2, 1 and -1 + (0-7)/2.
  const auto critic_y = [&] { return make()->critic_target_values(batch, *q.online, kEnd); };
  expect_values(critic_y(), {0.5, 1, -4.5});
  options.ramp = full(1.6);  // around 2 action 1 comes within reach, and so does action 0 around 0
  expect_values(critic_y(), {-1.5, 1, -4.5});
  options.critic_eps = 0.2;
  expect_values(critic_y(), {0.5, 1, -4.5});
  options.critic_target_network = false;
  expect_values(critic_y(), {0, 1, -3.5});
  options.reach_at_state = true;  // the greedy action of 0 is 1, and of 1 it is 0
  expect_values(critic_y(), {-1.5, 1, -2});
  options.reach_at_state = false;
  options.critic_target_network = true;

  // Errors of the critic 0.5 + 2, 1 + 2, -4.5 + 5; of Q 1, 0, -0.5: the acting values choose like Q here.
  const LossValue value = (*make())(batch, *q.online, *q.target, kEnd);
  expect_values(value.loss, {0.5 + 2, 0 + 2.5, 0.125 + 0.125});
  expect_values(value.td_error, {1, 0, -0.5});
  // With a share of 0.9 they choose action 0 in 0: 0.1 (1, 2) + 0.9 (-2, -5). Then y = -1 + Q'(0)_0 / 2 there.
  options.worst_share = 0.9;
  expect_values(make()->target_values(batch, *q.online, *q.target), {2, 1, -1});
  options.reach_of_acting_values = true;  // and what is reachable at 0 is then action 0
  expect_values(critic_y(), {0.5, 1, -2.5});
  options.critic_floor = -1;
  expect_values(critic_y(), {0.5, 1, -1});
  const auto values = make()->acting(q.online);
  EXPECT_TRUE(torch::allclose(values->forward(row({0}).unsqueeze(1)), row({0.1 - 1.8, 0.2 - 4.5}).unsqueeze(0)));
}

// What sampling brings about is reachable; with a smaller radius than the attacker's it would not be.
TEST(WocarLoss, NoActionThatCanBeBroughtAboutIsMissing) {
  torch::NoGradGuard no_grad;
  const QNetworkShape shape{.inputs = 2, .hidden = {8, 8}, .actions = 4};
  std::array<long, 2> missing{};
  long unreachable = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    for (const bool faulty : {false, true}) {
      Stream rng(seed, 51);
      const auto online = random_network(shape, rng, torch::kFloat, 2);
      WocarLossOptions options;
      options.worst_share = 0.4;
      options.reach_bounds = BoundMethod::crown;
      if (faulty) options.critic_eps = 0.1;
      options.ramp.eps = 0.5;
      WocarLoss loss(options, shape, rng);
      const Tensor states = random_points(8, 2, 0, 10, rng, torch::kFloat);
      const Tensor reach = loss.reachable(states, *online, kEnd);
      unreachable += (~reach).sum().item<long>();
      const auto acting = loss.acting(online);
      for (int i = 0; i < 20; ++i) {
        const Tensor x = (states + random_points(8, 2, -0.5, 0.5, rng, torch::kFloat)).clamp(0, 10);
        missing[faulty] += (~of_actions(reach, acting->forward(x).argmax(1))).sum().item<long>();
      }
    }
  }
  EXPECT_EQ(missing[false], 0);
  EXPECT_GT(missing[true], 20);
  EXPECT_GT(unreachable, 500);
}

TEST(WocarLoss, RobustTermsHandComputed) {
  const Batch batch = three_transitions();
  Affine q;
  const auto critic = network_of({{{{0}, {2}}, {0, 0}}});  // importance 2|x|: 0, 0, 2
  WocarLossOptions options;
  options.td.discount = 0.5;
  options.ramp = full(0.2);
  const auto term = [&] {
    const Tensor values = q.online->forward(batch.states);
    return wocar(options, *critic, *critic)->robust_term(batch, *q.online, values, row({2, 1, 0.5}), kEnd);
  };
  // Taken 1 - 0.2 against y = 2, 1 and 0.5; the other action's upper end exceeds its value by 0.2.
  const double other = huber_of(0.2);
  expect_values(term(), {huber_of(1.2) + other, huber_of(0.2) + other, huber_of(0.3) + other});
  options.robust_term = WocarRobustTerm::both_ends;
  expect_values(term(), {huber_of(1.2) + other, huber_of(0.2) + other, huber_of(0.7) + other});
  options.robust_term = WocarRobustTerm::important_hinge;
  expect_values(term(), {0, 0, 3 * -0.6});
}

TEST(WocarLoss, OwnsItsCritic) {
  Stream rng(21);
  const QNetworkShape shape{.inputs = 2, .hidden = {4}, .actions = 3};
  WocarLoss loss({}, shape, rng);
  const auto online = std::make_shared<QNetwork>(shape, rng), target = std::make_shared<QNetwork>(shape, rng);
  ASSERT_EQ(loss.modules().size(), 2u);
  long trained = 0;
  for (const auto& module : loss.modules())
    for (const Tensor& p : module->parameters()) trained += p.requires_grad() ? p.numel() : 0;
  EXPECT_EQ(trained, online->parameter_count());
  const auto same = [&] { return torch::equal(loss.critic().parameters()[0], loss.critic_target().parameters()[0]); };
  EXPECT_TRUE(same());

  // One step down the gradient: the critic and the online network move, the two target networks do not.
  torch::optim::SGD optimiser(online->parameters(), 0.1);
  optimiser.add_param_group(torch::optim::OptimizerParamGroup(loss.critic().parameters()));
  const Tensor states = random_points(16, 2, 0, 10, rng, torch::kFloat);
  const Batch batch{states, torch::arange(16) % 3, torch::ones(16), torch::zeros(16), states.flip(0), {}};
  const Tensor target_before = target->parameters()[0].clone(), online_before = online->parameters()[0].clone();
  loss(batch, *online, *target, kEnd).loss.mean().backward();
  optimiser.step();
  EXPECT_FALSE(same());
  EXPECT_FALSE(torch::equal(online->parameters()[0], online_before));
  EXPECT_TRUE(torch::equal(target->parameters()[0], target_before));
  EXPECT_FALSE(target->parameters()[0].grad().defined());
  loss.copy_targets();
  EXPECT_TRUE(same());
  loss.start_from(*online);
  EXPECT_TRUE(torch::equal(loss.critic_target().forward(states), online->forward(states)));
}

struct Named {
  std::string name;
  std::shared_ptr<Loss> loss;
};

std::vector<Named> all_losses(const PerturbationRamp& ramp, const QNetworkShape& shape, Stream& rng) {
  const auto wocar_with = [&](WocarRobustTerm term) {
    WocarLossOptions options;
    options.ramp = ramp;
    options.robust_term = term;
    auto loss = std::make_shared<WocarLoss>(options, shape, rng);
    for (const auto& module : loss->modules()) module->to(torch::kDouble);
    return loss;
  };
  RadialLossOptions merged{.ramp = ramp, .bounds = BoundMethod::crown};
  merged.overlap = RadialOverlap::merged_difference;
  return {{"sa", std::make_shared<SaLoss>(SaLossOptions{.ramp = ramp, .kappa = 0.1})},
          {"radial", std::make_shared<RadialLoss>(RadialLossOptions{.ramp = ramp})},
          {"radial merged", std::make_shared<RadialLoss>(merged)},
          {"wocar", wocar_with(WocarRobustTerm::bad_ends)},
          {"wocar both", wocar_with(WocarRobustTerm::both_ends)},
          {"wocar hinge", wocar_with(WocarRobustTerm::important_hinge)},
          {"car", std::make_shared<CarLoss>(CarLossOptions{.ramp = ramp})}};
}

Batch random_batch(const QNetworkShape& shape, long n, Stream& rng) {
  std::vector<int64_t> actions;
  for (long i = 0; i < n; ++i) actions.push_back(rng.below(static_cast<int>(shape.actions)));
  return {
      random_points(n, shape.inputs, 0, 10, rng), torch::tensor(actions, torch::kLong),
      random_points(n, 1, -1, 1, rng).squeeze(1), (random_points(n, 1, 0, 1, rng).squeeze(1) < 0.2).to(torch::kDouble),
      random_points(n, shape.inputs, 0, 10, rng), {}};
}

// With weights that count as constants held fixed: CAR's softmax, Radial's distances and WocaR's importance have no
// gradient, so those are compared where they are constant, i.e. as the loss of frozen weights.
TEST(Losses, GradientsAgreeWithNumericDifferences) {
  const QNetworkShape shape{.inputs = 2, .hidden = {5, 4}, .actions = 3};
  PerturbationRamp ramp{.eps = 0.3};
  long compared = 0;
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    Stream rng(seed, 31);
    const auto online = random_network(shape, rng, torch::kDouble), target = random_network(shape, rng, torch::kDouble);
    const Batch batch = random_batch(shape, 4, rng);
    for (const auto& [name, loss] : all_losses(ramp, shape, rng)) {
      if (name.starts_with("radial") || name == "car") continue;  // below
      const auto total = [&, &loss_ = *loss] { return loss_(batch, *online, *target, {0.35}).loss.sum(); };
      online->zero_grad();
      total().backward();
      for (const Tensor& p : online->parameters()) {
        // The targets of Double DQN choose by the online network, but only through an argmax.
        const Tensor numeric = numeric_gradient([&] { return number(total()); }, p);
        EXPECT_TRUE(torch::allclose(p.grad(), numeric, 1e-4, 1e-5)) << name << p.grad() << numeric;
        compared += (numeric.abs() > 1e-3).sum().item<long>();
      }
    }
    // CAR with an immense temperature: weights are constant. With small ones the gradient is that of the weighted sum.
    CarLossOptions mean{.ramp = ramp, .lambda = 1e12};
    online->zero_grad();
    CarLoss{mean}(batch, *online, *target, kEnd).loss.sum().backward();
    for (const Tensor& p : online->parameters()) {
      const auto value = [&] { return number(CarLoss{mean}(batch, *online, *target, kEnd).loss.sum()); };
      EXPECT_TRUE(torch::allclose(p.grad(), numeric_gradient(value, p), 1e-4, 1e-5));
    }
    CarLossOptions soft{.ramp = ramp, .lambda = 0.5};
    const Tensor weights =
        (CarLoss{soft}(batch, *online, *target, kEnd).loss / CarLoss{mean}(batch, *online, *target, kEnd).loss)
            .detach();
    online->zero_grad();
    CarLoss{soft}(batch, *online, *target, kEnd).loss.sum().backward();
    for (const Tensor& p : online->parameters()) {
      const auto value = [&] { return number((weights * CarLoss{mean}(batch, *online, *target, kEnd).loss).sum()); };
      EXPECT_TRUE(torch::allclose(p.grad(), numeric_gradient(value, p), 1e-4, 1e-5));
    }
    // Radial: distances frozen, so values enter `adversarial` as they were.
    for (const RadialOverlap overlap : {RadialOverlap::separate_bounds, RadialOverlap::merged_difference}) {
      RadialLossOptions options{.ramp = ramp, .overlap = overlap};
      const Tensor values = online->forward(batch.states).detach();
      const auto total = [&] { return RadialLoss(options).adversarial(batch, values, *online, kEnd).sum(); };
      online->zero_grad();
      total().backward();
      for (const Tensor& p : online->parameters()) {
        const Tensor numeric = numeric_gradient([&] { return number(total()); }, p);
        EXPECT_TRUE(torch::allclose(p.grad(), numeric, 1e-4, 1e-5));
        compared += (numeric.abs() > 1e-3).sum().item<long>();
      }
    }
  }
  EXPECT_GT(compared, 200) << "gradients that are all zero agree with anything";
}

// With no perturbation each loss is the temporal difference and what theory leaves of its own term.
TEST(Losses, WithoutPerturbationTheyReduceToTd) {
  const QNetworkShape shape{.inputs = 2, .hidden = {16, 16}, .actions = 4};
  Stream rng(41);
  const auto online = random_network(shape, rng, torch::kDouble), target = random_network(shape, rng, torch::kDouble);
  const Batch batch = random_batch(shape, 32, rng);
  const Tensor values = online->forward(batch.states).detach();
  const Tensor error = next_state_target(batch, *online, *target, TdOptions{}) - of_actions(values, batch.actions);
  const Tensor td = huber(error, 1);
  const Tensor runner_up = std::get<0>(values.topk(2, 1)).select(1, 1) - values.amax(1);
  // Radius 0, and the full radius before the ramp begins.
  for (const auto& [ramp, progress] : std::vector<std::pair<PerturbationRamp, Progress>>{
           {PerturbationRamp{.eps = 0}, kEnd}, {PerturbationRamp{.eps = 1, .start = 0.5}, {0.25}}}) {
    for (const auto& [name, loss] : all_losses(ramp, shape, rng)) {
      const LossValue value = (*loss)(batch, *online, *target, progress);
      Tensor expected = td;
      if (name == "sa") expected = td + 0.1 * runner_up.clamp_min(-1);
      if (name.starts_with("radial")) expected = 0.8 * td;  // ranges that are points do not overlap
      if (name == "car") expected = 32 * torch::softmax(error.abs(), 0) * td;
      if (name.starts_with("wocar")) {
        auto& own = dynamic_cast<WocarLoss&>(*loss);
        const Tensor y = own.target_values(batch, *online, *target);
        const Tensor q_td = huber(y - of_actions(values, batch.actions), 1);
        // Nothing but the action of the acting values is reachable.
        const Tensor acting = own.acting(online)->forward(batch.next_states).argmax(1);
        const Tensor critic_y = batch.rewards + 0.99 * (1 - batch.terminal) *
                                                    of_actions(own.critic_target().forward(batch.next_states), acting);
        const Tensor critic_td = huber(critic_y - of_actions(own.critic().forward(batch.states), batch.actions), 1);
        const double kappa = ramp.share(progress) > 0 ? 0.8 : 1;
        expected = q_td + critic_td;  // kappa TD + (1 - kappa) TD
        if (name == "wocar hinge") {
          const Tensor worst = own.critic().forward(batch.states);
          const Tensor importance = worst.amax(1) - worst.amin(1);
          expected = kappa * q_td + critic_td + (1 - kappa) * importance / importance.mean() * runner_up.clamp_min(-1);
        }
      }
      EXPECT_TRUE(torch::allclose(value.loss.detach(), expected.detach(), 1e-9, 1e-9)) << name;
      // A control: with a perturbation it is something else, and larger on average.
      const PerturbationRamp some{.eps = 1};
      if (!name.starts_with("wocar")) {
        for (const auto& [other, robust] : all_losses(some, shape, rng)) {
          if (other != name) continue;
          EXPECT_GT(number((*robust)(batch, *online, *target, kEnd).loss.mean()), number(expected.mean()) + 1e-4)
              << name;
        }
      }
    }
  }
}

TEST(Losses, BadOptionsAreNamed) {
  const auto message = [](const std::function<void()>& f) -> std::string {
    try {
      f();
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const PerturbationRamp negative{.eps = -1}, backwards{.start = 0.6, .end = 0.5};
  EXPECT_EQ(message([&] { SaLoss({.ramp = negative}); }), "SA loss: eps is -1, expected finite and at least 0");
  EXPECT_EQ(message([&] { RadialLoss({.ramp = backwards}); }),
            "Radial loss: the ramp's start is 0.6, expected 0 to its end");
  EXPECT_EQ(message([] { SaLoss({.ramp = {}, .kappa = -1}); }), "SA loss: kappa is -1, expected at least 0");
  EXPECT_EQ(message([] { RadialLoss({.ramp = {}, .kappa = 1.5}); }), "Radial loss: kappa is 1.5, expected 0 to 1");
  EXPECT_EQ(message([] { CarLoss({.ramp = {}, .lambda = 0}); }), "CAR loss: lambda is 0, expected above 0, e.g. 1");
  EXPECT_EQ(message([] { CarLoss({.td = {.discount = 2}, .ramp = {}}); }), "CAR loss: discount is 2, expected 0 to 1");
  Stream rng(1);
  WocarLossOptions options;
  options.worst_share = -0.5;
  EXPECT_EQ(message([&] { WocarLoss(options, {}, rng); }), "WocaR loss: worst_share is -0.5, expected 0 to 1");
  EXPECT_EQ(message([&] { WocarLoss({}, {}, rng); }), "");
}

}  // namespace
}  // namespace maximin::deep
