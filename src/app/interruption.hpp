// Ctrl-C and SIGTERM, for commands that stop in good order.
#pragma once

#include "app/commands.hpp"

namespace plica {

/// Record SIGINT and SIGTERM instead of ending the program.
void catch_interruptions();

/// Whether a signal has arrived.
bool interrupted();

/// Whether a signal has arrived and `seconds` have passed since the first call after it. Called often, it gives work
/// under way time to finish.
bool interrupted_for(double seconds);

/// Exit status for the last signal.
ExitStatus interrupted_status();

}  // namespace plica
