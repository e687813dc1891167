#pragma once

#include <atomic>

namespace maximin::apps {

/// Makes SIGINT and SIGTERM raise a flag instead of ending the program, so that it can end with what is done so far. A
/// second signal ends it at once. Returns the flag; the same one on every call.
std::atomic<bool>& stop_on_interrupt();

}  // namespace maximin::apps
