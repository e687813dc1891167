#include <maximin/proofs_check/report/svg_axis.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace maximin::report {
namespace {

/// Tolerates the rounding of a logarithm or a quotient that should be whole.
double floor_of(double x) {
  return std::floor(x + 1e-9);
}
double ceil_of(double x) {
  return std::ceil(x - 1e-9);
}

/// 10^k, written 10⁻⁴ where the plain number would be long.
std::string power_of_ten(int k) {
  if (k >= -3 && k <= 3) return fmt::format("{:g}", std::pow(10.0, k));
  static constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = k < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(k))) text += digits[c - '0'];
  return text;
}

/// A multiple of `step`, with the digits that tell it from its neighbours when none is larger than `magnitude`.
std::string plain_number(double value, double step, double magnitude) {
  const int last = static_cast<int>(floor_of(std::log10(step)));
  if (last >= -5 && last < 6) return fmt::format("{:.{}f}", value, std::max(0, -last));
  const int first = static_cast<int>(floor_of(std::log10(std::max(magnitude, step))));
  return fmt::format("{:.{}g}", value, first - last + 2);
}

/// 1, 2 and 5 times powers of ten, from the last at or below `low` to the first at or above `high`.
std::vector<Tick> fine_ticks(double low, double high, int first, int last) {
  std::vector<Tick> all;
  for (int k = first; k <= last; ++k) {
    for (const int m : {1, 2, 5}) {
      const double value = m * std::pow(10.0, k);
      all.push_back({value, m == 1 ? power_of_ten(k) : fmt::format("{:g}", value)});
    }
  }
  const auto from = std::find_if(all.rbegin(), all.rend(), [&](const Tick& t) { return t.value <= low * 1.000001; });
  const auto to = std::find_if(all.begin(), all.end(), [&](const Tick& t) { return t.value >= high * 0.999999; });
  const auto begin = from == all.rend() ? all.begin() : from.base() - 1;
  return {begin, to == all.end() ? to : to + 1};
}

}  // namespace

Axis Axis::linear(double low, double high, int about) {
  if (!std::isfinite(low) || !std::isfinite(high) || low > high) {
    low = 0;
    high = 1;
  }
  const double magnitude = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-9 * magnitude) {
    low = magnitude == 0 ? 0 : low - magnitude / 2;
    high = magnitude == 0 ? 1 : high + magnitude / 2;
  }
  const double rough = (high - low) / std::max(1, about);
  const double unit = std::pow(10.0, floor_of(std::log10(rough)));
  const double share = rough / unit;
  const double step = unit * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
  Axis axis;
  const double first = floor_of(low / step), last = ceil_of(high / step);
  for (double i = first; i <= last; ++i) {
    const double value = i == 0 ? 0 : i * step;
    axis.ticks_.push_back({value, plain_number(value, step, magnitude)});
  }
  axis.low_ = axis.ticks_.front().value;
  axis.high_ = axis.ticks_.back().value;
  return axis;
}

Axis Axis::logarithmic(double low, double high, bool zero) {
  if (!(low > 0 && std::isfinite(high) && low <= high)) {
    low = 0.1;
    high = 1;
  }
  const int first = static_cast<int>(floor_of(std::log10(low)));
  const int last = std::max(first + 1, static_cast<int>(ceil_of(std::log10(high))));
  Axis axis;
  axis.logarithmic_ = true;
  axis.band_ = zero ? 0.13 : 0;
  if (last - first <= 2) {
    axis.ticks_ = fine_ticks(low, high, first, last);
    if (axis.ticks_.size() < 2)
      axis.ticks_ = {{std::pow(10.0, first), power_of_ten(first)}, {std::pow(10.0, last), power_of_ten(last)}};
    axis.low_ = axis.ticks_.front().value;
    axis.high_ = axis.ticks_.back().value;
  } else {
    const int stride = (last - first + 5) / 6;
    for (int k = last; k >= first; k -= stride)
      axis.ticks_.insert(axis.ticks_.begin(), {std::pow(10.0, k), power_of_ten(k)});
    axis.low_ = std::pow(10.0, first);
    axis.high_ = std::pow(10.0, last);
  }
  if (zero) axis.ticks_.insert(axis.ticks_.begin(), {0, "0"});
  return axis;
}

double Axis::at(double value) const {
  if (!logarithmic_) return std::isnan(value) ? 0 : std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
  if (!(value >= low_ * 0.999999)) return band_ > 0 ? band_ * 0.3 : 0;
  const double share = std::log(value / low_) / std::log(high_ / low_);
  return band_ + (1 - band_) * std::clamp(share, 0.0, 1.0);
}

bool Axis::shows(double value) const {
  const double below = 1e-6 * (logarithmic_ ? low_ : high_ - low_);
  const double above = 1e-6 * (logarithmic_ ? high_ : high_ - low_);
  return value >= low_ - below && value <= high_ + above;
}

}  // namespace maximin::report
