// Work that may crash, in a process of its own.
#pragma once

#include <functional>
#include <optional>
#include <shared_mutex>
#include <string>

namespace plica {

/// What `work` returns when it runs in a copy of this process (fork), so that nothing it does to memory matters here;
/// empty when that process crashed, was killed or `work` threw. What it says on stderr is not shown. The process
/// ends with this one, even when that is killed. `work` must not use threads that this process has started (OpenMP).
/// FileError when no process can be started, or when the other one stands still for `stall_s`: it is asleep and uses no
/// processor time (one that waits for a disk is not asleep). The error says `what` it was to do. It is ended then.
std::optional<std::string> output_of_child(const std::string& what, const std::function<std::string()>& work,
                                           double stall_s = 120);

/// Held, shared, by each thread of this process's own while it works: a child process starts when none does. It would
/// inherit whatever lock such a thread is holding, for ever.
std::shared_mutex& work_beside();

}  // namespace plica
