#include "app/interruption.hpp"

#include <csignal>

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

ExitStatus interrupted_status() { return caught_signal == SIGTERM ? exit_terminated : exit_interrupted; }

}  // namespace plica
