// Work that may crash, in a child process.
#pragma once

#include <functional>
#include <optional>
#include <shared_mutex>
#include <string>

namespace plica {

/// Run `work` in a fork of this process and return its result; empty if the child crashed, was killed or `work` threw.
/// Memory of this process is not affected, and stderr of the child is discarded. The child ends with this process, even
/// if that is killed. `work` must not use threads started by this process (OpenMP). Throws FileError if no process can
/// be started, or if the child sleeps for `stall_s` without using the processor (waiting for a disk does not count); it
/// is then killed. `what`: name of the work in messages.
std::optional<std::string> output_of_child(const std::string& what, const std::function<std::string()>& work,
                                           double stall_s = 120);

/// Mutex that threads started by this process hold shared while they work. A child process starts only when none does,
/// since it would inherit a held lock permanently.
std::shared_mutex& work_beside();

}  // namespace plica
