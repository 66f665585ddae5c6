#include "interrupt.hpp"

#include <atomic>
#include <csignal>

namespace pirouette::app {
namespace {

std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free, "set by a signal handler");

extern "C" void remember_signal(int signal) { received = signal; }

}  // namespace

void watch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, remember_signal);
}

int interrupt_signal() { return received; }

}  // namespace pirouette::app
