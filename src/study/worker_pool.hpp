// Pool of worker processes of this program. Each does one piece of work after another; a crash affects no other.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace plica {

/// Number of worker processes, and of threads in each. Results depend on neither.
struct Workers {
  int processes = 1, threads = 1;
};

struct WorkerHooks {
  /// Receives the answer to a piece of work; empty if its process ended twice, with the `reason`.
  std::function<void(std::size_t work, const std::string& answer, const std::string& reason)> on_answer;
  /// Polled often; once true, work under way is abandoned and no more starts.
  std::function<bool()> stop_requested;
};

/// Whether this worker was asked to stop; its return value is not used then. Call within `do_work`.
bool worker_is_to_stop();

/// Do the pieces of work in order in `workers` forks of this process, which must have no other threads. They end with
/// this process, even if it is killed. A piece whose process ends is repeated once. Throws FileError if no process can
/// be started, or from `do_work`.
void work_in_processes(int workers, std::span<const std::size_t> pieces,
                       const std::function<std::string(std::size_t)>& do_work, const WorkerHooks& hooks);

}  // namespace plica
