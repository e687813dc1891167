#pragma once

#include <maximin/models/model.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

/// The decimal that is meant by a finite double: the shortest that reads back as it, so that 0.1 is 1/10.
Rational decimal(double x);

/// The model in the decimals that its numbers stand for. Rows are divided by their sum, which is 1 to rounding, so that
/// they sum to 1 exactly.
Model<Rational> rationalise(const Model<double>& model);

/// The model in floating point, for pictures: each number is within its last bit of the exact one. Throws InputError
/// where a reward is beyond floating point.
Model<double> rounded(const Model<Rational>& model);

/// A model of short decimals near this one, for exact arithmetic that repeats itself many times: probabilities are
/// multiples of 1/4096 (what is less than half of one is dropped, what is missing goes to the largest), rewards and the
/// discount have at most 3 decimals. `rationalise` reads them as they are meant. The constants are near those of the
/// model and must be taken anew.
Model<double> coarsen(Model<double> model);

}  // namespace maximin
