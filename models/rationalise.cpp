#include <maximin/models/rationalise.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include <maximin/models/files/internal/number.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// The model with another MDP and all its other numbers converted.
template <class To, class From, class Convert>
Model<To> converted(FiniteMdp<To> mdp, const Model<From>& model, Convert convert) {
  Model<To> result{std::move(mdp)};
  result.name = model.name;
  result.state_names = model.state_names;
  result.action_names = model.action_names;
  result.notes = model.notes;
  for (const From& p : model.start) result.start.push_back(convert(p));
  auto& g = result.geometry;
  g.kind = static_cast<typename Geometry<To>::Kind>(model.geometry.kind);
  g.points = model.geometry.points.unaryExpr(convert);
  g.norm = model.geometry.norm;
  g.distances = model.geometry.distances.unaryExpr(convert);
  g.neighbourhoods = model.geometry.neighbourhoods;
  if (model.geometry.eps) g.eps = convert(*model.geometry.eps);
  return result;
}

/// Adds the row of (s,a), divided by its sum.
void add_row(FiniteMdpBuilder<Rational>& builder, State s, Action a, const std::vector<Successor<Rational>>& row) {
  Rational sum(0);
  for (const auto& next : row) sum += next.probability;
  for (const auto& next : row) builder.transition(s, a, next.target, next.probability / sum);
}

constexpr long grain = 4096;

/// x to three decimals.
double to_thousandths(double x) {
  return std::stod(fmt::format("{:.3f}", x));
}

/// The row in whole grains, by entry.
std::vector<long> in_grains(FiniteMdp<double>::Row row) {
  std::vector<long> grains;
  long left = grain;
  for (const auto& next : row) left -= grains.emplace_back(std::lround(next.probability * static_cast<double>(grain)));
  *std::max_element(grains.begin(), grains.end()) += left;
  return grains;
}

}  // namespace

Rational decimal(double x) {
  if (!std::isfinite(x)) throw InputError("number: not finite, expected a finite one");
  Rational value;
  if (internal::parse_number(fmt::format("{}", x), value) != internal::NumberFault::none) {
    throw InputError(fmt::format("number {}: too long for exact arithmetic, expected fewer digits", x));
  }
  return value;
}

Model<Rational> rationalise(const Model<double>& model) {
  const FiniteMdp<double>& mdp = model.mdp;
  FiniteMdpBuilder<Rational> builder(mdp.states(), mdp.actions(), decimal(mdp.discount()));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, decimal(mdp.reward(s, a)));
      std::vector<Successor<Rational>> row;
      for (const auto& next : mdp.successors(s, a)) row.push_back({next.target, decimal(next.probability)});
      add_row(builder, s, a, row);
    }
  }
  auto exact = converted<Rational>(std::move(builder).build(), model, [](double x) { return decimal(x); });
  const Rational total = std::accumulate(exact.start.begin(), exact.start.end(), Rational(0));
  for (Rational& p : exact.start) p /= total;
  return exact;
}

Model<double> rounded(const Model<Rational>& model) {
  const auto near = [](const Rational& x) { return static_cast<double>(x); };
  const FiniteMdp<Rational>& mdp = model.mdp;
  FiniteMdpBuilder<double> builder(mdp.states(), mdp.actions(), near(mdp.discount()));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, near(mdp.reward(s, a)));
      for (const auto& next : mdp.successors(s, a)) builder.transition(s, a, next.target, near(next.probability));
    }
  }
  return converted<double>(std::move(builder).build(), model, near);
}

Model<double> coarsen(Model<double> model) {
  const FiniteMdp<double>& mdp = model.mdp;
  FiniteMdpBuilder<double> builder(mdp.states(), mdp.actions(), std::min(to_thousandths(mdp.discount()), 0.999));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, to_thousandths(mdp.reward(s, a)));
      const auto row = mdp.successors(s, a);
      const std::vector<long> grains = in_grains(row);
      for (std::size_t i = 0; i < grains.size(); ++i) {
        builder.transition(s, a, row[i].target, static_cast<double>(grains[i]) / static_cast<double>(grain));
      }
    }
  }
  model.mdp = std::move(builder).build();
  return model;
}

}  // namespace maximin
