#pragma once

#include <functional>
#include <vector>

#include <maximin/models/model.hpp>

namespace maximin {

/// Whether a model still shows what is being hunted.
using ModelPredicate = std::function<bool(const Model<double>&)>;

/// The simplest model found that still satisfies `keeps`, from one that does: tries every simplification of
/// `visit_simpler_models`, takes the first that keeps it, and starts again until none does or `max_tests` were tried.
/// Names, notes and the start distribution are dropped if that keeps it too.
Model<double> shrink(Model<double> model, const ModelPredicate& keeps, long max_tests = 20'000);

/// Calls `visit` with models that are simpler by one step, most aggressive first, until it returns true; returns
/// whether it did. Each is valid, and comes before the given one in the order "fewer states, then fewer actions, then
/// fewer transitions and characters to write all numbers down", so that shrinking ends. The steps:
///
/// - drop half of the states, or one; what led to a dropped state stays where it is, or leads to another
/// - drop an action, a dimension of the points
/// - make all rows deterministic, all rewards 0, integers, or of one or two decimals
/// - move the points to the origin, measure them in units of eps, round them (they may then coincide); round eps and
///   the discount
/// - the same for one row, one reward, one point; round a row to multiples of 1/2, 1/4, 1/8, 1/64
bool visit_simpler_models(const Model<double>& model, const ModelPredicate& visit);

/// All that visit_simpler_models visits.
std::vector<Model<double>> simpler_models(const Model<double>& model);

}  // namespace maximin
