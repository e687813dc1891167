#include <maximin/models/rationalise.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <maximin/models/files/internal/number.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

Model<Rational> with_mdp(FiniteMdp<Rational> mdp, const Model<double>& model) {
  Model<Rational> result{std::move(mdp)};
  result.name = model.name;
  result.state_names = model.state_names;
  result.action_names = model.action_names;
  result.notes = model.notes;
  Rational total(0);
  for (const double p : model.start) total += result.start.emplace_back(decimal(p));
  for (Rational& p : result.start) p /= total;
  auto& g = result.geometry;
  g.kind = static_cast<Geometry<Rational>::Kind>(model.geometry.kind);
  g.points = model.geometry.points.unaryExpr([](double x) { return decimal(x); });
  g.norm = model.geometry.norm;
  g.distances = model.geometry.distances.unaryExpr([](double x) { return decimal(x); });
  g.neighbourhoods = model.geometry.neighbourhoods;
  if (model.geometry.eps) g.eps = decimal(*model.geometry.eps);
  return result;
}

/// Adds the row of (s,a), divided by its sum.
void add_row(FiniteMdpBuilder<Rational>& builder, State s, Action a, const std::vector<Successor<Rational>>& row) {
  Rational sum(0);
  for (const auto& next : row) sum += next.probability;
  for (const auto& next : row) builder.transition(s, a, next.target, next.probability / sum);
}

/// x to so many decimals.
Rational rounded(double x, int digits) {
  return decimal(std::stod(fmt::format("{:.{}f}", x, digits)));
}

/// The row in multiples of 1/grain.
std::vector<Successor<Rational>> in_grains(FiniteMdp<double>::Row row, long grain) {
  std::vector<long> grains;
  long left = grain;
  for (const auto& next : row) left -= grains.emplace_back(std::lround(next.probability * static_cast<double>(grain)));
  *std::max_element(grains.begin(), grains.end()) += left;
  std::vector<Successor<Rational>> result;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains[i] > 0) result.push_back({row[i].target, Rational(grains[i], grain)});
  }
  return result;
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
  return with_mdp(std::move(builder).build(), model);
}

Model<Rational> coarsen(const Model<double>& model, long grain, int digits) {
  const FiniteMdp<double>& mdp = model.mdp;
  const Rational largest = 1 - 1 / Rational(boost::multiprecision::pow(Integer(10), static_cast<unsigned>(digits)));
  FiniteMdpBuilder<Rational> builder(mdp.states(), mdp.actions(), std::min(rounded(mdp.discount(), digits), largest));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, rounded(mdp.reward(s, a), digits));
      add_row(builder, s, a, in_grains(mdp.successors(s, a), grain));
    }
  }
  return with_mdp(std::move(builder).build(), model);
}

}  // namespace maximin
