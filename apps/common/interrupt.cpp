#include <maximin/apps/common/interrupt.hpp>

#include <unistd.h>
#include <csignal>

namespace maximin::apps {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch a lock-free atomic");

extern "C" void raise_flag(int) {
  interrupted = true;
  static constexpr char text[] =
      "\nstopping once what is under way is safe; a second signal ends the program at once\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) return;  // nobody listens
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
