#pragma once

#include <maximin/models/model.hpp>

namespace maximin {

/// The model with every reward multiplied by `factor` > 0: l_r, R_max, span and every bound scale with it, and nothing
/// else changes.
Model<double> scale_rewards(const Model<double>& model, double factor);

/// The model with its points and eps multiplied by `factor` > 0: the balls stay (up to rounding), l_r and l_p are
/// divided by it. Throws InputError when the model has no points.
Model<double> scale_space(const Model<double>& model, double factor);

/// The model with P = (1-t) nu_a + t P in the place of P, nu_a the average row of action a, 0 <= t <= 1: every
/// difference of probabilities, hence l_p and K, is multiplied by t.
Model<double> contract_kernel(const Model<double>& model, double t);

}  // namespace maximin
