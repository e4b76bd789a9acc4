// Ctrl-C and SIGTERM, for commands that then stop in good order.
#pragma once

#include "app/commands.hpp"

namespace plica {

/// From now on SIGINT and SIGTERM are noted and do not end the program.
void catch_interruptions();

/// One of them has come.
bool interrupted();

/// The same, that many seconds after this has first been asked since: asked often, it leaves work under way the time to
/// end well.
bool interrupted_for(double seconds);

/// The exit status for the one that came last.
ExitStatus interrupted_status();

}  // namespace plica
