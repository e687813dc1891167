#include <maximin/deep/runtime.hpp>

namespace {

/// Before the first test of every program: with several threads small networks take many times as long.
const bool runtime_is_prepared = (maximin::deep::prepare_runtime(), true);

}  // namespace
