#include <maximin/proofs_check/falsify/climb.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model_draft.hpp>
#include <maximin/models/rationalise.hpp>

namespace maximin {
namespace {

using Row = ModelDraft::Row;

template <class List>
auto& any_of(List& list, Stream& rng) {
  return list[static_cast<std::size_t>(rng.below(static_cast<int>(list.size())))];
}

double rounded(double x) {
  return std::round(x * 1000) / 1000;
}

/// A step of either sign, mostly small.
double step(double size, Stream& rng) {
  const double u = rng.uniform(-1, 1);
  return size * u * u * u;
}

void change_reward(ModelDraft& draft, Stream& rng) {
  const double span = std::max(draft.rewards.maxCoeff() - draft.rewards.minCoeff(), 1.0);
  double& r = draft.rewards(rng.below(draft.states()), rng.below(draft.actions()));
  r = rng.chance(0.3) ? draft.rewards(rng.below(draft.states()), rng.below(draft.actions()))
                      : rounded(r + step(span, rng));
}

Row& any_row(ModelDraft& draft, Stream& rng) {
  return any_of(any_of(draft.rows, rng), rng);
}

void add(Row& row, State target, double probability) {
  const auto at = std::lower_bound(row.begin(), row.end(), target,
                                   [](const Successor<double>& next, State t) { return next.target < t; });
  if (at != row.end() && at->target == target) {
    at->probability += probability;
  } else {
    row.insert(at, {target, probability});
  }
}

void move_probability(ModelDraft& draft, Stream& rng) {
  Row& row = any_row(draft, rng);
  const auto from = static_cast<std::size_t>(rng.below(static_cast<int>(row.size())));
  const double moved = row[from].probability * (rng.chance(0.3) ? 1.0 : rng.uniform());
  row[from].probability -= moved;
  if (!(row[from].probability > 0)) row.erase(row.begin() + static_cast<std::ptrdiff_t>(from));
  add(row, rng.below(draft.states()), moved);
}

void copy_row(ModelDraft& draft, Stream& rng) {
  const auto a = static_cast<std::size_t>(rng.below(draft.actions()));
  const Row row = any_of(draft.rows, rng)[a];
  any_of(draft.rows, rng)[a] = row;
}

void move_point(ModelDraft& draft, Stream& rng) {
  auto& points = draft.whole.geometry.points;
  double& x = points(rng.below(draft.states()), rng.below(static_cast<int>(points.cols())));
  const double spread = std::max(points.maxCoeff() - points.minCoeff(), 1e-3);
  x = rng.chance(0.3) ? points(rng.below(draft.states()), 0) : rounded(x + step(spread, rng));
}

void change_eps(ModelDraft& draft, Stream& rng) {
  const auto& g = draft.whole.geometry;
  const auto metric = Metric<double>::from_points(g.points, g.norm);
  const double d = metric.distance(rng.below(draft.states()), rng.below(draft.states()));
  draft.whole.geometry.eps = std::ceil(d * 1000) / 1000;
}

}  // namespace

Model<double> random_change(const Model<double>& model, Stream& rng) {
  ModelDraft draft(model);
  const double u = rng.uniform();
  if (u < 0.35) {
    change_reward(draft, rng);
  } else if (u < 0.6) {
    move_probability(draft, rng);
  } else if (u < 0.68) {
    Row& row = any_row(draft, rng);
    row = deterministic_row(row);
  } else if (u < 0.76) {
    copy_row(draft, rng);
  } else if (u < 0.86) {
    move_point(draft, rng);
  } else if (u < 0.92) {
    change_eps(draft, rng);
  } else {
    draft.discount = std::clamp(rounded(draft.discount + step(0.3, rng)), 0.001, 0.98);
  }
  return coarsen(std::move(draft).build());
}

Climb climb(Model<double> start, const std::function<double(const Model<double>&)>& score, long steps, Stream& rng) {
  Climb best{coarsen(std::move(start)), 0};
  best.score = score(best.model);
  for (long k = 0; k < steps; ++k) {
    Model<double> next = random_change(best.model, rng);
    const double found = score(next);
    if (!(found >= best.score)) continue;
    best = {std::move(next), found};
  }
  return best;
}

}  // namespace maximin
