#include <maximin/deep/output_bounds.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

using torch::Tensor;

// Each layer adds as many roundings as its dot products have terms, and these: of biases, slopes, middles and radii.
constexpr double kFurtherRoundings = 8;

// Below this width the chord of an unstable ReLU is drawn as if the interval were that wide. It stays a bound, and its
// derivative, which goes with one over the width, stays of use.
constexpr double kLeastWidth = 1e-5;

double machine_epsilon(const Tensor& t) {
  return t.scalar_type() == torch::kDouble ? std::numeric_limits<double>::epsilon()
                                           : static_cast<double>(std::numeric_limits<float>::epsilon());
}

struct Interval {
  Tensor low, high;  // [n, width]

  Tensor middle() const { return (low + high) / 2; }
  Tensor radius() const { return (high - low) / 2; }
  Interval relu() const { return {torch::relu(low), torch::relu(high)}; }
  Interval meet(const Interval& other) const {
    return {torch::maximum(low, other.low), torch::minimum(high, other.high)};
  }
};

// k affine functions of a layer's activations.
struct AffineRows {
  Tensor rows;    // [k, width]
  Tensor offset;  // [k]
  // What the rows are made of, in absolute values: the scale of rounding errors. No gradient.
  Tensor row_magnitude, offset_magnitude;

  static AffineRows of(const torch::nn::Linear& layer) {
    return {layer->weight, layer->bias, layer->weight.detach().abs(), layer->bias.detach().abs()};
  }

  double terms() const { return static_cast<double>(rows.size(-1)) + kFurtherRoundings; }
};

// rows x per sample: [n, k] from x [n, width].
Tensor times(const Tensor& rows, const Tensor& x) {
  return rows.dim() == 2 ? x.matmul(rows.t()) : rows.matmul(x.unsqueeze(2)).squeeze(2);
}

// What rounding can amount to where the rows are applied to what is made of such magnitudes, after so many roundings.
Tensor margin(const AffineRows& f, const Tensor& magnitude, double roundings_before) {
  const Tensor sums = times(f.row_magnitude, magnitude) + f.offset_magnitude;
  return machine_epsilon(sums) * (roundings_before + f.terms()) * sums;
}

// What affine functions of a box are between: rows middle +- |rows| radius, exact but for rounding.
Interval interval_image(const AffineRows& f, const Interval& x) {
  const Tensor middle = x.middle(), radius = x.radius();
  const Tensor centre = times(f.rows, middle) + f.offset;
  const Tensor reach = times(f.rows.abs(), radius) + margin(f, (middle.abs() + radius).detach(), 0);
  return {centre - reach, centre + reach};
}

// relu(z) <= upper_slope z + intercept and relu(z) >= lower_slope z for z in an interval. [n, width] each.
struct Relaxation {
  Tensor upper_slope, intercept, lower_slope;
  Tensor alive;  // 0 where relu is 0 on the whole interval

  // The chord above; below, z or 0, whichever leaves the smaller area: CROWN's adaptive slope.
  static Relaxation over(const Interval& z) {
    const Tensor l = z.low.clamp_max(0), u = z.high.clamp_min(0);
    const Tensor active = z.low >= 0, dead = z.high <= 0;
    const Tensor chord = u / (u - l).clamp_min(kLeastWidth);
    const Tensor slope = torch::where(active, torch::ones_like(chord), chord);
    // Any slope will do if the intercept lifts the line above relu at both ends.
    Tensor lift = torch::maximum(-slope * l, u - slope * u);
    lift = lift + 4 * machine_epsilon(l) * (u - slope * l).detach();
    const Tensor none = torch::zeros_like(lift);
    const Tensor below = torch::logical_or(active, torch::logical_and(z.high > -z.low, torch::logical_not(dead)));
    return {torch::where(dead, none, slope), torch::where(torch::logical_or(active, dead), none, lift),
            below.to(lift.scalar_type()), torch::logical_not(dead).to(lift.scalar_type())};
  }
};

// What stands before the first layer, over a box. Rounding is monotone, so the ends of the box go through the very
// operations that its points go through; sines and cosines are 1 or -1 where the interval passes a crest or a trough,
// else what they are at its ends, widened by the rounding of the angle and of the function.
Interval feature_interval(const QNetwork& q, const StateBox& box) {
  const Tensor a = q.features(box.low), b = q.features(box.high);
  const long inputs = q.shape().inputs;
  Interval out{torch::minimum(a, b), torch::maximum(a, b)};
  double frequency = std::numbers::pi;
  for (long w = 0; w < q.shape().waves; ++w, frequency *= 2) {
    const Tensor low = box.low * frequency, high = box.high * frequency;
    const Tensor slack = machine_epsilon(low) * (4 + 2 * torch::maximum(low.abs(), high.abs()));
    // sin has its crests at pi/2 + 2 pi k, cos at 2 pi k; troughs lie half a turn on.
    const auto passes = [&](double phase) {
      return torch::floor((high + slack - phase) / (2 * std::numbers::pi)) >=
             torch::ceil((low - slack - phase) / (2 * std::numbers::pi));
    };
    for (const int cosine : {0, 1}) {
      const long column = inputs * (1 + 2 * w + cosine);
      const double crest = cosine != 0 ? 0 : std::numbers::pi / 2;
      Tensor least = out.low.narrow(1, column, inputs), most = out.high.narrow(1, column, inputs);
      most.copy_(torch::where(passes(crest), torch::ones_like(most), (most + slack).clamp_max(1)));
      least.copy_(
          torch::where(passes(crest + std::numbers::pi), -torch::ones_like(least), (least - slack).clamp_min(-1)));
    }
  }
  return out;
}

// All that is known of the hidden layers of one network over the boxes of a batch.
class HiddenBounds {
 public:
  HiddenBounds(const QNetwork& q, const StateBox& box, BoundMethod method);

  // What affine functions of the last hidden layer's activations are between, [n, k].
  Interval image(const AffineRows& f) const;

  // Upper bounds of Q_a - Q_b, for all pairs ([n, a, b]) and against one reference action per sample ([n, a]).
  Tensor all_differences(const AffineRows& q) const;
  Tensor differences(const AffineRows& q, const Tensor& reference) const;

 private:
  bool linear_hidden() const { return method_ == BoundMethod::crown || method_ == BoundMethod::tightest; }
  bool linear_outputs() const { return method_ != BoundMethod::ibp && !layers_.empty(); }
  bool interval_outputs() const { return method_ == BoundMethod::tightest || !linear_outputs(); }
  void add_layer(const torch::nn::Linear& layer);
  Interval linear_image(const AffineRows& f) const;
  Tensor linear_value(Tensor rows, Tensor offset) const;

  BoundMethod method_;
  Interval input_;        // after what stands before the first layer
  Interval activations_;  // of the last layer so far
  Tensor magnitude_;      // of what is added up on the way to the last layer so far, [n, width]
  double roundings_ = 0;  // on the way there
  std::vector<torch::nn::Linear> layers_;
  std::vector<Relaxation> relaxations_;
};

HiddenBounds::HiddenBounds(const QNetwork& q, const StateBox& box, BoundMethod method) : method_(method) {
  input_ = feature_interval(q, box);
  activations_ = input_;
  magnitude_ = (input_.middle().abs() + input_.radius()).detach();
  for (std::size_t i = 0; i + 1 < q.layers().size(); ++i) add_layer(q.layers()[i]);
}

void HiddenBounds::add_layer(const torch::nn::Linear& layer) {
  const AffineRows f = AffineRows::of(layer);
  Interval z = interval_image(f, activations_);
  // Of the first layer's sums the intervals are exact.
  if (linear_hidden() && !layers_.empty()) z = z.meet(linear_image(f));
  const Relaxation relaxation = Relaxation::over(z);
  {
    torch::NoGradGuard no_grad;
    const Tensor before = times(f.row_magnitude, magnitude_) + f.offset_magnitude;
    magnitude_ = relaxation.alive * before + relaxation.intercept;
  }
  roundings_ += f.terms();
  layers_.push_back(layer);
  relaxations_.push_back(relaxation);
  activations_ = z.relu();
}

Interval HiddenBounds::image(const AffineRows& f) const {
  if (!linear_outputs()) return interval_image(f, activations_);
  const Interval linear = linear_image(f);
  return interval_outputs() ? linear.meet(interval_image(f, activations_)) : linear;
}

// One layer down: what was `a` times the activations plus `d` becomes that in terms of the activations before.
void step_down(const Relaxation& relu, const torch::nn::Linear& layer, Tensor& a, Tensor& d) {
  const Tensor above = a.clamp_min(0), below = a.clamp_max(0);
  const long k = a.size(1), width_before = layer->weight.size(1);
  if (a.size(0) == 1 && width_before < k) {
    // Rows shared by all samples and few inputs: scaling the weights instead of the rows is far less work.
    const Tensor weights = torch::cat({layer->weight, layer->bias.unsqueeze(1)}, 1);
    Tensor upper_weights = relu.upper_slope.unsqueeze(2) * weights;
    const Tensor lift = torch::constant_pad_nd(relu.intercept.unsqueeze(2), {width_before, 0});
    const Tensor both = above.matmul(upper_weights + lift) + below.matmul(relu.lower_slope.unsqueeze(2) * weights);
    a = both.narrow(2, 0, width_before);
    d = d + both.select(2, width_before);
    return;
  }
  d = d + above.matmul(relu.intercept.unsqueeze(2)).squeeze(2);
  a = above * relu.upper_slope.unsqueeze(1) + below * relu.lower_slope.unsqueeze(1);
  d = d + a.matmul(layer->bias);
  a = a.matmul(layer->weight);
}

// The greatest value that linear bounds leave to affine functions of the last layer's activations, but for rounding.
// Rows [k, width] with offset [k], or [n, k, width] with [n, k].
Tensor HiddenBounds::linear_value(Tensor rows, Tensor offset) const {
  Tensor a = rows.dim() == 2 ? rows.unsqueeze(0) : rows;
  Tensor d = offset.dim() == 1 ? offset.unsqueeze(0) : offset;
  for (std::size_t i = layers_.size(); i-- > 0;) step_down(relaxations_[i], layers_[i], a, d);
  return d + times(a, input_.middle()) + times(a.abs(), input_.radius());
}

Interval HiddenBounds::linear_image(const AffineRows& f) const {
  const long k = f.rows.size(0);
  // An upper bound of the negative is a lower bound.
  const Tensor upper = linear_value(torch::cat({f.rows, -f.rows}), torch::cat({f.offset, -f.offset}));
  const Tensor rounding = margin(f, magnitude_, roundings_);
  return {-(upper.narrow(1, k, k) + rounding), upper.narrow(1, 0, k) + rounding};
}

Tensor HiddenBounds::all_differences(const AffineRows& q) const {
  const long k = q.rows.size(0);
  const auto pairs = [](const Tensor& a, const Tensor& b) { return (a.unsqueeze(1) + b).flatten(0, 1); };
  const AffineRows f{pairs(q.rows, -q.rows), pairs(q.offset, -q.offset), pairs(q.row_magnitude, q.row_magnitude),
                     pairs(q.offset_magnitude, q.offset_magnitude)};
  Tensor upper;
  if (linear_outputs()) upper = linear_value(f.rows, f.offset) + margin(f, magnitude_, roundings_);
  if (interval_outputs()) {
    const Tensor high = interval_image(f, activations_).high;
    upper = upper.defined() ? torch::minimum(upper, high) : high;
  }
  return upper.view({-1, k, k});
}

Tensor HiddenBounds::differences(const AffineRows& q, const Tensor& reference) const {
  const Tensor column = reference.unsqueeze(1);
  Tensor upper;
  if (linear_outputs()) {
    const Tensor rows = q.rows - q.rows.index_select(0, reference).unsqueeze(1);
    const Tensor offset = q.offset - q.offset.index_select(0, reference).unsqueeze(1);
    const Tensor rounding = margin(q, magnitude_, roundings_);
    upper = linear_value(rows, offset) + rounding + rounding.gather(1, column);
  }
  if (interval_outputs()) {
    // With intervals all pairs cost less than rows that differ from sample to sample.
    HiddenBounds intervals = *this;
    intervals.method_ = BoundMethod::ibp;
    const long k = q.rows.size(0);
    const Tensor high = intervals.all_differences(q).gather(2, column.unsqueeze(2).expand({-1, k, 1})).squeeze(2);
    upper = upper.defined() ? torch::minimum(upper, high) : high;
  }
  return upper;
}

std::string shape_text(const Tensor& t) {
  std::string text = "[";
  for (const auto size : t.sizes()) text += (text.size() > 1 ? ", " : "") + std::to_string(size);
  return text + "]";
}

void check(const QNetwork& q, const StateBox& box) {
  const Tensor& weight = q.layers().front()->weight;
  if (weight.scalar_type() != torch::kFloat && weight.scalar_type() != torch::kDouble)
    throw InputError("output bounds: a network that is neither float nor double, expected one of these");
  const long inputs = q.shape().inputs;
  for (const Tensor& side : {box.low, box.high}) {
    if (side.dim() != 2 || side.size(1) != inputs || side.size(0) != box.low.size(0))
      throw InputError("output bounds: a box of shape " + shape_text(side) + ", expected [n, " +
                       std::to_string(inputs) + "] on both sides");
    if (side.scalar_type() != weight.scalar_type())
      throw InputError("output bounds: a box in another precision than the network, expected the same");
  }
  if (!(box.low <= box.high).all().item<bool>())
    throw InputError("output bounds: a box with low above high or not a number, expected low <= high");
}

}  // namespace

StateBox ball_around(const Tensor& states, double eps, StateRange range) {
  if (!(eps >= 0 && std::isfinite(eps)))
    throw InputError("ball: eps " + std::to_string(eps) + ", expected finite and at least 0");
  if (!(range.low <= range.high)) throw InputError("ball: an empty range of states, expected low <= high");
  torch::NoGradGuard no_grad;
  const Tensor centre = states.detach();
  Tensor radius = torch::full_like(centre, eps);
  if (eps > 0) radius += 4 * machine_epsilon(centre) * (centre.abs() + eps);
  return {(centre - radius).clamp(range.low, range.high), (centre + radius).clamp(range.low, range.high)};
}

OutputBounds output_bounds(const QNetwork& q, const StateBox& box, BoundMethod method) {
  check(q, box);
  const Interval q_range = HiddenBounds(q, box, method).image(AffineRows::of(q.layers().back()));
  return {q_range.low, q_range.high};
}

Tensor difference_upper_bounds(const QNetwork& q, const StateBox& box, const Tensor& reference, BoundMethod method) {
  check(q, box);
  if (reference.dim() != 1 || reference.size(0) != box.low.size(0) || reference.scalar_type() != torch::kLong)
    throw InputError("difference bounds: reference actions of shape " + shape_text(reference) +
                     ", expected one int64 per box");
  const Tensor upper = HiddenBounds(q, box, method).differences(AffineRows::of(q.layers().back()), reference);
  const Tensor itself = torch::zeros_like(upper, torch::kBool).scatter(1, reference.unsqueeze(1), true);
  return upper.masked_fill(itself, 0);
}

Tensor pairwise_difference_upper_bounds(const QNetwork& q, const StateBox& box, BoundMethod method) {
  check(q, box);
  const Tensor upper = HiddenBounds(q, box, method).all_differences(AffineRows::of(q.layers().back()));
  const long actions = q.shape().actions;
  return upper.masked_fill(torch::eye(actions, upper.options()).to(torch::kBool), 0);
}

Tensor possibly_greedy(const Tensor& pairwise_upper_bounds) {
  return (pairwise_upper_bounds >= 0).all(2);
}

}  // namespace maximin::deep
