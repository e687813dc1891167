#pragma once

#include "options.hpp"

namespace maximin::verify_bound {

/// Examines one model, from a file or built in. Returns the exit code.
int run_model_command(const Options& options);

}  // namespace maximin::verify_bound
