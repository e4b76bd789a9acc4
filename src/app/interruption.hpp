// Ctrl-C and SIGTERM, for commands that stop in good order.
#pragma once

#include <chrono>
#include <csignal>
#include <optional>

#include "app/commands.hpp"

namespace plica {

inline volatile std::sig_atomic_t caught_signal = 0;

/// Record SIGINT and SIGTERM instead of ending the program.
inline void catch_interruptions() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int caught) { caught_signal = caught; });
}

/// Whether a signal has arrived.
inline bool interrupted() { return caught_signal != 0; }

/// Whether a signal has arrived and `seconds` have passed since the first call after it. Called often, it gives work
/// under way time to finish.
inline bool interrupted_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  static std::optional<Clock::time_point> seen;
  if (!interrupted()) return false;
  if (!seen) seen = Clock::now();
  return std::chrono::duration<double>(Clock::now() - *seen).count() >= seconds;
}

/// Exit status for the last signal.
inline ExitStatus interrupted_status() { return caught_signal == SIGTERM ? exit_terminated : exit_interrupted; }

}  // namespace plica
