// Signals that end a run in good order.
#pragma once

namespace pirouette::app {

/// From now on SIGINT, SIGTERM and SIGHUP are only remembered.
void watch_interrupts();

/// Number of the signal that came, 0 for none. Any thread may ask.
int interrupt_signal();

}  // namespace pirouette::app
