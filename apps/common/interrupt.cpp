#include <maximin/apps/common/interrupt.hpp>

#include <csignal>

namespace maximin::apps {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch a lock-free atomic");

extern "C" void raise_flag(int) {
  interrupted = true;
}

}  // namespace

std::atomic<bool>& stop_on_interrupt() {
  struct sigaction action {};
  action.sa_handler = raise_flag;
  // The second signal finds the default action: it ends a program that does not get around to looking at the flag.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return interrupted;
}

}  // namespace maximin::apps
