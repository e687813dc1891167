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
  return with_mdp(std::move(builder).build(), model);
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
