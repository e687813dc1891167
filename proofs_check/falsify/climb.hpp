#pragma once

#include <functional>

#include <maximin/models/model.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// A random small change of a model with points: a reward moved, or set to that of another entry; probability moved
/// from one successor to another; a row made deterministic, or that of a neighbour; a point moved; eps set to a
/// distance between two states; the discount changed. Always a valid model, in short decimals.
Model<double> random_change(const Model<double>& model, Stream& rng);

/// The best model found and its score.
struct Climb {
  Model<double> model;
  double score;
};

/// Hill climbing from a model: of `steps` random changes, keeps those that do not lower the score.
Climb climb(Model<double> start, const std::function<double(const Model<double>&)>& score, long steps, Stream& rng);

}  // namespace maximin
