#include <maximin/deep/output_bounds.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <maximin/theory/error.hpp>

#include "tiny_networks.hpp"

namespace maximin::deep {
namespace {

using torch::Tensor;

constexpr std::array kMethods{BoundMethod::ibp, BoundMethod::crown_ibp, BoundMethod::crown, BoundMethod::tightest};

QNetworkShape random_shape(Stream& rng) {
  QNetworkShape shape;
  shape.inputs = rng.integer(1, 4);
  shape.actions = rng.integer(1, 5);
  shape.hidden.clear();
  for (int layers = rng.integer(0, 3); layers > 0; --layers) shape.hidden.push_back(rng.integer(1, 24));
  shape.input_centre = rng.uniform(-1, 6);
  shape.input_scale = rng.uniform(-0.5, 0.5);
  shape.waves = rng.integer(0, 3);
  return shape;
}

double random_radius(Stream& rng) {
  constexpr std::array radii{0.0, 1e-6, 1e-3, 0.1, 0.5, 3.0};
  return radii[static_cast<std::size_t>(rng.below(static_cast<int>(radii.size())))];
}

// m points per box, [m, n, inputs]: inside, on faces and in corners, each a float of the box.
Tensor points_of(const StateBox& box, long m, Stream& rng) {
  std::vector<Tensor> list;
  for (long i = 0; i < m; ++i) {
    Tensor t = random_points(box.low.size(0), box.low.size(1), 0, 1, rng, box.low.scalar_type());
    if (i % 3 == 1) t = t.round();
    if (i % 3 == 2) t = (2 * t - 0.5).clamp(0, 1);
    const Tensor x = box.low + t * (box.high - box.low);
    list.push_back(torch::minimum(torch::maximum(x, box.low), box.high));
  }
  return torch::stack(list);
}

// How many values at the points lie outside the bounds [n, actions]: the check that everything below relies on.
long outside(const Tensor& values, const OutputBounds& bounds) {
  return (torch::logical_or(values<bounds.lower, values> bounds.upper)).sum().item<long>();
}

Tensor values_at(QNetwork& q, const Tensor& points) {
  return q.forward(points.flatten(0, 1)).view({points.size(0), points.size(1), -1});
}

// Interval arithmetic as it is easily got wrong.
enum class Fault { forgets_negative_weights, swaps_sides, forgets_relu_of_low, none };
OutputBounds faulty_intervals(const QNetwork& q, const StateBox& box, Fault fault) {
  Tensor low = q.features(box.low), high = q.features(box.high);
  for (std::size_t i = 0; i < q.layers().size(); ++i) {
    const auto& layer = q.layers()[i];
    if (i > 0) {
      low = fault == Fault::forgets_relu_of_low ? torch::relu(high) : torch::relu(low);
      high = torch::relu(high);
    }
    const Tensor plus = layer->weight.clamp_min(0).t(), minus = layer->weight.clamp_max(0).t();
    const Tensor a = low, b = high;
    low = (fault == Fault::forgets_negative_weights ? a.matmul(plus + minus) : a.matmul(plus) + b.matmul(minus)) +
          layer->bias;
    high = (fault == Fault::forgets_negative_weights ? b.matmul(plus + minus) : b.matmul(plus) + a.matmul(minus)) +
           layer->bias;
  }
  return fault == Fault::swaps_sides ? OutputBounds{high, low} : OutputBounds{low, high};
}

// No tolerance anywhere: bounds hold for what the network computes in floats.
RC_GTEST_PROP(OutputBounds, NoPointOfTheBoxIsOutside, (std::uint64_t seed)) {
  torch::NoGradGuard no_grad;
  Stream rng(seed);
  const auto q = random_network(random_shape(rng), rng, rng.chance(0.8) ? torch::kFloat : torch::kDouble);
  const auto type = q->layers()[0]->weight.scalar_type();
  const Tensor states = random_points(4, q->shape().inputs, 0, 10, rng, type);
  const StateBox box = ball_around(states, random_radius(rng));
  const Tensor values = values_at(*q, points_of(box, 12, rng));
  const Tensor differences = values.unsqueeze(3) - values.unsqueeze(2);
  const Tensor reference = values[0].argmax(1);
  for (const BoundMethod method : kMethods) {
    RC_ASSERT(outside(values, output_bounds(*q, box, method)) == 0);
    const Tensor pairs = pairwise_difference_upper_bounds(*q, box, method);
    RC_ASSERT((differences > pairs).sum().item<long>() == 0);
    RC_ASSERT((pairs.diagonal(0, 1, 2) == 0).all().item<bool>());
    const Tensor leads = difference_upper_bounds(*q, box, reference, method);
    RC_ASSERT((values - values.gather(2, reference.view({1, -1, 1}).expand({12, -1, 1})) > leads).sum().item<long>() ==
              0);
    // Whatever is greedy somewhere is possibly greedy.
    const Tensor greedy = torch::zeros_like(values, torch::kBool).scatter(2, values.argmax(2, true), true).any(0);
    RC_ASSERT(torch::logical_or(torch::logical_not(greedy), possibly_greedy(pairs)).all().item<bool>());
  }
}

TEST(OutputBounds, TheSamplingCheckSeesFaultyBounds) {
  torch::NoGradGuard no_grad;
  std::array<long, 4> found{};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Stream rng(seed);
    const auto q = random_network({.inputs = 2, .hidden = {12, 12}, .actions = 3}, rng, torch::kDouble);
    const StateBox box = ball_around(random_points(4, 2, 0, 10, rng), 0.5);
    const Tensor values = values_at(*q, points_of(box, 12, rng));
    for (const Fault fault :
         {Fault::forgets_negative_weights, Fault::swaps_sides, Fault::forgets_relu_of_low, Fault::none})
      found[static_cast<std::size_t>(fault)] += outside(values, faulty_intervals(*q, box, fault));
    // Differences of bounds of the same side, as in "subtract the mean of the upper bounds", are no bounds.
    const OutputBounds ibp = output_bounds(*q, box, BoundMethod::ibp);
    const Tensor centred = values - values.mean(2, true);
    EXPECT_EQ(outside(centred, {ibp.lower - ibp.upper.mean(1, true), ibp.upper - ibp.lower.mean(1, true)}), 0);
  }
  EXPECT_GT(found[0], 100);
  EXPECT_GT(found[1], 1000);
  EXPECT_GT(found[2], 100);
  EXPECT_EQ(found[3], 0) << "the check itself must not invent violations";
}

TEST(OutputBounds, SubtractingTheMeanOfTheSameSideIsUnsound) {
  torch::NoGradGuard no_grad;
  // Q = (x, -x) on [-1, 1]: Q minus its mean over actions is Q, which reaches 1. Upper bounds are (1, 1), and minus
  // their mean 0.
  const auto q = network_of({{{{1}, {-1}}, {0, 0}}});
  const StateBox box = ball_around(torch::zeros({1, 1}, torch::kDouble), 1, {-1, 1});
  const OutputBounds bounds = output_bounds(*q, box, BoundMethod::tightest);
  const Tensor ends = values_at(*q, torch::stack({box.low, box.high}));
  EXPECT_EQ(outside(ends, bounds), 0);
  EXPECT_GT(outside(ends - ends.mean(2, true),
                    {bounds.lower - bounds.lower.mean(1, true), bounds.upper - bounds.upper.mean(1, true)}),
            0);
  // With the centring merged into the last layer bounds are exact.
  const auto centred = network_of({{{{1}, {-1}}, {0, 0}}});
  for (const auto& p : centred->parameters()) p.sub_(p.mean(0, true));
  EXPECT_NEAR(output_bounds(*centred, box, BoundMethod::ibp).upper[0][0].item<double>(), 1, 1e-12);
}

TEST(OutputBounds, HandComputed) {
  torch::NoGradGuard no_grad;
  // |x| on [-1, 2] as relu(x) + relu(-x). Chords: 2/3 x + 2/3 and -1/3 x + 2/3, in sum x/3 + 4/3, at 2 exactly 2.
  // Below, the adaptive slopes are 1 and 0, in sum x, at -1 that is -1; intervals give 0 and 3.
  const auto q = network_of({{{{1}, {-1}}, {0, 0}}, {{{1, 1}, {-1, 2}}, {0, 0.5}}});
  const StateBox box{torch::full({1, 1}, -1.0, torch::kDouble), torch::full({1, 1}, 2.0, torch::kDouble)};
  const auto expect = [&](BoundMethod method, double low0, double high0, double low1, double high1) {
    const OutputBounds b = output_bounds(*q, box, method);
    EXPECT_NEAR(b.lower[0][0].item<double>(), low0, 1e-12);
    EXPECT_NEAR(b.upper[0][0].item<double>(), high0, 1e-12);
    EXPECT_NEAR(b.lower[0][1].item<double>(), low1, 1e-12);
    EXPECT_NEAR(b.upper[0][1].item<double>(), high1, 1e-12);
  };
  // The second action is -relu(x) + 2 relu(-x) + 1/2, from 2.5 at -1 to -1.5 at 2. Above: -x + 2(-x/3 + 2/3) + 1/2 at
  // -1; below: -(2/3 x + 2/3) + 1/2 at 2.
  expect(BoundMethod::ibp, 0, 3, -1.5, 2.5);
  expect(BoundMethod::crown, -1, 2, -1.5, 3.5);
  expect(BoundMethod::crown_ibp, -1, 2, -1.5, 3.5);
  expect(BoundMethod::tightest, 0, 2, -1.5, 2.5);
  // Q_1 - Q_0 = -2 relu(x) + relu(-x) + 1/2, merged: intervals to 1.5; separate ones only to 2.5.
  EXPECT_NEAR(pairwise_difference_upper_bounds(*q, box, BoundMethod::ibp)[0][1][0].item<double>(), 1.5, 1e-12);
  const Tensor reference = torch::zeros({1}, torch::kLong);
  const Tensor leads = difference_upper_bounds(*q, box, reference, BoundMethod::ibp);
  EXPECT_NEAR(leads[0][1].item<double>(), 1.5, 1e-12);
  EXPECT_EQ(leads[0][0].item<double>(), 0);
}

// Least and greatest value of each action over a box, exactly (in double): a network of one hidden layer is affine
// between its kinks, so that extremes lie in corners, where kinks cross edges, or where two kinks cross.
OutputBounds enumerate_one_hidden_layer(QNetwork& q, const std::array<double, 2>& low,
                                        const std::array<double, 2>& high) {
  std::vector<double> points;
  const auto add = [&](double x, double y) {
    if (x >= low[0] && x <= high[0] && y >= low[1] && y <= high[1]) points.insert(points.end(), {x, y});
  };
  struct Line {
    double a, b, c;  // a x + b y = c
  };
  std::vector<Line> lines{{1, 0, low[0]}, {1, 0, high[0]}, {0, 1, low[1]}, {0, 1, high[1]}};
  const auto w = q.layers()[0]->weight.accessor<double, 2>();
  const auto bias = q.layers()[0]->bias.accessor<double, 1>();
  for (long j = 0; j < w.size(0); ++j) lines.push_back({w[j][0], w[j][1], -bias[j]});
  for (const Line& p : lines) {
    for (const Line& r : lines) {
      const double det = p.a * r.b - r.a * p.b;
      if (std::abs(det) > 1e-12) add((p.c * r.b - r.c * p.b) / det, (p.a * r.c - r.a * p.c) / det);
    }
  }
  const Tensor values = q.forward(torch::tensor(points, torch::kDouble).view({-1, 2}));
  return {values.amin(0), values.amax(0)};
}

TEST(OutputBounds, AgainstExactEnumeration) {
  torch::NoGradGuard no_grad;
  std::array<double, 4> excess{};  // of the widths over the exact ones, by method
  double exact_width = 0;
  long caught = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Stream rng(seed, 1);
    QNetworkShape shape{.inputs = 2, .hidden = {6}, .actions = 3, .input_centre = 0, .input_scale = 1};
    const auto q = random_network(shape, rng, torch::kDouble);
    const std::array low{rng.uniform(-1, 1), rng.uniform(-1, 1)};
    const std::array high{low[0] + rng.uniform(0.05, 1), low[1] + rng.uniform(0.05, 1)};
    const OutputBounds exact = enumerate_one_hidden_layer(*q, low, high);
    const auto row = [](const std::array<double, 2>& x) {
      return torch::tensor(std::vector<double>(x.begin(), x.end()), torch::kDouble).unsqueeze(0);
    };
    const StateBox box{row(low), row(high)};
    exact_width += (exact.upper - exact.lower).sum().item<double>();
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      const OutputBounds bound = output_bounds(*q, box, kMethods[m]);
      EXPECT_TRUE((bound.upper[0] >= exact.upper).all().item<bool>());
      EXPECT_TRUE((bound.lower[0] <= exact.lower).all().item<bool>());
      excess[m] += (bound.upper[0] - exact.upper + exact.lower - bound.lower[0]).sum().item<double>();
    }
    // A corner is not enough: the comparison with exact values would notice who looks there alone.
    const Tensor corners =
        torch::tensor({low[0], low[1], low[0], high[1], high[0], low[1], high[0], high[1]}, torch::kDouble);
    caught += (q->forward(corners.view({4, 2})).amax(0) < exact.upper - 1e-9).sum().item<long>();
  }
  EXPECT_GT(caught, 10);
  EXPECT_LT(excess[1], 0.5 * excess[0]) << "linear bounds are narrower than intervals on average";
  EXPECT_NEAR(excess[2], excess[1], 1e-9) << "with one hidden layer there is nothing more to bound";
  EXPECT_LE(excess[3], excess[2]);
  EXPECT_LT(excess[3], 0.2 * exact_width);
  EXPECT_GT(excess[3], 0);
}

TEST(OutputBounds, WithoutKinksLinearBoundsAreExact) {
  torch::NoGradGuard no_grad;
  Stream rng(3);
  // Large biases keep every unit on one side, so that the network is affine on the box and its corners tell all.
  const auto q = random_network({.inputs = 2, .hidden = {9, 9}, .actions = 4}, rng, torch::kDouble);
  for (std::size_t i = 0; i < 2; ++i) q->layers()[i]->bias.add_(torch::where(q->layers()[i]->bias > 0, 50., -50.));
  const StateBox box = ball_around(random_points(8, 2, 0, 10, rng), 0.7);
  std::vector<Tensor> corners;
  for (const bool x : {false, true})
    for (const bool y : {false, true})
      corners.push_back(
          torch::stack({(x ? box.high : box.low).select(1, 0), (y ? box.high : box.low).select(1, 1)}, 1));
  const Tensor values = values_at(*q, torch::stack(corners));
  for (const BoundMethod method : {BoundMethod::crown_ibp, BoundMethod::crown, BoundMethod::tightest}) {
    const OutputBounds b = output_bounds(*q, box, method);
    EXPECT_TRUE(torch::allclose(b.upper, values.amax(0), 0, 1e-9));
    EXPECT_TRUE(torch::allclose(b.lower, values.amin(0), 0, 1e-9));
  }
  EXPECT_FALSE(torch::allclose(output_bounds(*q, box, BoundMethod::ibp).upper, values.amax(0), 0, 1e-3));
}

// On the network of the experiments, in floats.
TEST(OutputBounds, WidthsByRadiusAndMethod) {
  torch::NoGradGuard no_grad;
  Stream rng(4);
  const auto q = random_network({}, rng, torch::kFloat, 1.5);
  const Tensor states = random_points(64, 2, 0, 10, rng, torch::kFloat);
  const auto width = [&](double eps, BoundMethod method) {
    const OutputBounds b = output_bounds(*q, ball_around(states, eps), method);
    return (b.upper - b.lower);
  };
  const Tensor forward = q->forward(states);
  for (const BoundMethod method : kMethods) {
    // A box of no width: the value itself, up to the margin, which covers the value of another order of summation.
    const OutputBounds point = output_bounds(*q, ball_around(states, 0), method);
    EXPECT_EQ(outside(forward.unsqueeze(0), point), 0);
    EXPECT_TRUE(torch::allclose(point.upper, forward, 0, 2e-3));
    EXPECT_TRUE(torch::allclose(point.lower, forward, 0, 2e-3));
    double before = width(0, method).mean().item<double>();
    EXPECT_LT(before, 2e-3);
    for (const double eps : {0.01, 0.1, 0.5, 2.0}) {
      const double now = width(eps, method).mean().item<double>();
      EXPECT_GT(now, before);
      before = now;
    }
  }
  // The margin is needed: the exact values (in double) are not what the floats are, so as bounds they are caught.
  const auto exact = std::make_shared<QNetwork>(q->shape(), rng);
  exact->copy_from(*q);
  exact->to(torch::kDouble);
  const Tensor exact_values = exact->forward(states.to(torch::kDouble));
  EXPECT_GT(outside(forward.to(torch::kDouble).unsqueeze(0), {exact_values, exact_values}), 100);

  // Interval bounds of a ball hold those of a smaller one, entry by entry.
  for (const double eps : {0.01, 0.1, 0.5}) {
    const OutputBounds small = output_bounds(*q, ball_around(states, eps), BoundMethod::ibp);
    const OutputBounds large = output_bounds(*q, ball_around(states, 2 * eps), BoundMethod::ibp);
    EXPECT_TRUE((small.upper <= large.upper).all().item<bool>());
    EXPECT_TRUE((small.lower >= large.lower).all().item<bool>());
  }
  for (const double eps : {0.1, 0.5}) {
    const auto mean = [&](BoundMethod method) { return width(eps, method).mean().item<double>(); };
    EXPECT_LT(mean(BoundMethod::crown_ibp), mean(BoundMethod::ibp));
    EXPECT_LE(mean(BoundMethod::crown), mean(BoundMethod::crown_ibp));
    EXPECT_TRUE((width(eps, BoundMethod::tightest) <= width(eps, BoundMethod::crown)).all().item<bool>());
    // Merged differences are narrower than differences of bounds.
    const OutputBounds b = output_bounds(*q, ball_around(states, eps), BoundMethod::crown);
    const Tensor merged = pairwise_difference_upper_bounds(*q, ball_around(states, eps), BoundMethod::crown);
    EXPECT_LT(merged.sum().item<double>(), (b.upper.unsqueeze(2) - b.lower.unsqueeze(1)).sum().item<double>());
    RecordProperty("widths at " + std::to_string(eps),
                   std::to_string(mean(BoundMethod::ibp)) + " " + std::to_string(mean(BoundMethod::crown_ibp)) + " " +
                       std::to_string(mean(BoundMethod::crown)) + " " + std::to_string(mean(BoundMethod::tightest)));
  }
}

TEST(OutputBounds, GradientsAgreeWithNumericDifferences) {
  Stream rng(5);
  // Three layers of few units, and many actions with few units before them: both ways of stepping down a layer.
  for (const QNetworkShape& shape : {QNetworkShape{.inputs = 2, .hidden = {5, 4}, .actions = 3},
                                     QNetworkShape{.inputs = 3, .hidden = {3, 7}, .actions = 4}}) {
    const auto q = random_network(shape, rng, torch::kDouble);
    const StateBox box = ball_around(random_points(3, shape.inputs, 0, 10, rng), 0.5);
    const Tensor weights = random_points(2, shape.actions, -1, 1, rng);
    const Tensor reference = torch::zeros({3}, torch::kLong);
    for (const BoundMethod method : kMethods) {
      const auto scalar = [&] {
        const OutputBounds b = output_bounds(*q, box, method);
        return (b.upper * weights[0] + b.lower * weights[1]).sum() +
               (difference_upper_bounds(*q, box, reference, method) * weights[1]).sum() +
               (pairwise_difference_upper_bounds(*q, box, method) * weights[0]).square().sum();
      };
      q->zero_grad();
      scalar().backward();
      for (const Tensor& p : q->parameters()) {
        const Tensor numeric = numeric_gradient([&] { return scalar().item<double>(); }, p);
        EXPECT_TRUE(torch::allclose(p.grad(), numeric, 1e-5, 1e-5)) << p.grad() << numeric;
        // A control: the comparison sees a gradient that lacks a twentieth.
        if (numeric.abs().max().item<double>() > 0.01) {
          EXPECT_FALSE(torch::allclose(0.95 * p.grad(), numeric, 1e-5, 1e-5));
        }
      }
    }
  }
}

TEST(Ball, IsClippedAndRoundedOutwards) {
  Stream rng(6);
  for (const auto type : {torch::kFloat, torch::kDouble}) {
    const Tensor states = random_points(1000, 2, 0, 10, rng, type);
    const StateBox none = ball_around(states, 0);
    EXPECT_TRUE(torch::equal(none.low, states) && torch::equal(none.high, states));
    const StateBox box = ball_around(states, 0.3);
    const Tensor exact = states.to(torch::kDouble);
    EXPECT_TRUE((box.low.to(torch::kDouble) <= (exact - 0.3).clamp(0, 10)).all().item<bool>());
    EXPECT_TRUE((box.high.to(torch::kDouble) >= (exact + 0.3).clamp(0, 10)).all().item<bool>());
    EXPECT_TRUE(((box.high - box.low) <= 0.60002).all().item<bool>());
    EXPECT_EQ(box.low.min().item<double>(), 0);
    EXPECT_EQ(box.high.max().item<double>(), 10);
  }
  // The control: without the widening, floats lose a part of the ball.
  const Tensor states = random_points(1000, 2, 0, 10, rng, torch::kFloat);
  EXPECT_GT((((states + 0.3).to(torch::kDouble)) < states.to(torch::kDouble) + 0.3).sum().item<long>(), 100);
}

template <class F>
std::string message_of(const F& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(OutputBounds, BadInputIsNamed) {
  Stream rng(7);
  const auto q = random_network({.inputs = 2, .hidden = {3}, .actions = 2}, rng, torch::kFloat);
  const auto box = [](double low, double high, torch::Dtype type = torch::kFloat) {
    return StateBox{torch::full({1, 2}, low, type), torch::full({1, 2}, high, type)};
  };
  const auto bounds = [&](const StateBox& b) { return [&q, b] { output_bounds(*q, b, BoundMethod::ibp); }; };
  EXPECT_EQ(message_of(bounds(box(0, 1))), "");
  EXPECT_EQ(message_of(bounds(box(1, 0))),
            "output bounds: a box with low above high or not a number, expected low <= high");
  EXPECT_EQ(message_of(bounds(box(0, std::numeric_limits<double>::quiet_NaN()))),
            "output bounds: a box with low above high or not a number, expected low <= high");
  EXPECT_EQ(message_of(bounds(box(0, 1, torch::kDouble))),
            "output bounds: a box in another precision than the network, expected the same");
  EXPECT_EQ(message_of(bounds({torch::zeros({1, 3}), torch::zeros({1, 3})})),
            "output bounds: a box of shape [1, 3], expected [n, 2] on both sides");
  EXPECT_EQ(
      message_of([&] { difference_upper_bounds(*q, box(0, 1), torch::zeros({2}, torch::kLong), BoundMethod::ibp); }),
      "difference bounds: reference actions of shape [2], expected one int64 per box");
  EXPECT_EQ(message_of([] {
              ball_around(torch::zeros({1, 2}), -1);
            }),
            "ball: eps -1.000000, expected finite and at least 0");
  EXPECT_EQ(message_of([] {
              ball_around(torch::zeros({1, 2}), 1, {1, 0});
            }),
            "ball: an empty range of states, expected low <= high");
}

}  // namespace
}  // namespace maximin::deep
