#include "app/interruption.hpp"

#include <chrono>
#include <csignal>
#include <optional>

namespace plica {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

void note(int signal) { caught_signal = signal; }

}  // namespace

void catch_interruptions() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return caught_signal != 0; }

bool interrupted_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  static std::optional<Clock::time_point> seen;
  if (!interrupted()) return false;
  if (!seen) seen = Clock::now();
  return std::chrono::duration<double>(Clock::now() - *seen).count() >= seconds;
}

ExitStatus interrupted_status() { return caught_signal == SIGTERM ? exit_terminated : exit_interrupted; }

}  // namespace plica
