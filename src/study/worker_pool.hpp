// Work that is spread over processes of this program, which live on from one piece of work to the next. One that
// crashes takes no other with it.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace plica {

struct WorkerHooks {
  /// What a piece of work came to. Empty where its process ended twice over it; `reason` says how.
  std::function<void(std::size_t work, const std::string& answer, const std::string& reason)> on_answer;
  /// Asked often; once true, work under way is given up and the rest is not begun.
  std::function<bool()> stop_requested;
};

/// Within `do_work`: this process has been told to end well, and what it returns is not used.
bool worker_is_to_stop();

/// Has so many processes (forks of this one, which must have no other threads) do pieces of work, in their order. They
/// end with this process, even when that is killed. A piece whose process ends is begun once more. FileError when no
/// process can be started, and what `do_work` throws as one.
void work_in_processes(int workers, std::span<const std::size_t> pieces,
                       const std::function<std::string(std::size_t)>& do_work, const WorkerHooks& hooks);

}  // namespace plica
