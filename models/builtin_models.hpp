#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/models/model.hpp>

namespace maximin {

/// Examples that need no file. Each has a geometry with eps.
std::vector<std::string> builtin_model_names();

/// What the example shows, in one line. Throws InputError, as builtin_model.
std::string_view builtin_model_summary(std::string_view name);

/// The example of that name. Throws InputError that lists the names.
Model<double> builtin_model(std::string_view name);

}  // namespace maximin
