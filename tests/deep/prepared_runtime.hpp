#pragma once

#include <maximin/deep/runtime.hpp>

namespace maximin::deep {

/// Prepares the process before the first test; include it once in a test program.
inline const bool runtime_is_prepared = (prepare_runtime(), true);

}  // namespace maximin::deep
