// Commands of which the work is done by the Python package.
#pragma once

#include <string>
#include <vector>

namespace plica {

/// Become `python -m module words`, with the Python of the environment that this program is installed in, or else of
/// PATH. Returns, with an exit status, only if that fails. Throws UsageError, with the command and what to install, if
/// that Python does not find the module.
int become_module(const std::string& command, const std::string& module, const std::vector<std::string>& words,
                  const std::string& to_install);

}  // namespace plica
