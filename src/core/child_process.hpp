// Child processes. They end with this process, even if that is killed.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

namespace plica {

/// Fork of this process, joined to it by a socket.
class ChildProcess {
 public:
  /// The child calls `work` with its end of the socket and exits with the status returned (1 after an exception),
  /// without destructors and buffers, which are the parent's. Throws FileError if no process can be started.
  explicit ChildProcess(const std::function<int(int end)>& work);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  [[nodiscard]] pid_t id() const { return process_; }
  [[nodiscard]] int end() const { return end_; }  // of the socket, for the parent
  void send(int signal) const;
  /// Close the socket and wait for the child to end; after half a minute kill it. Returns the status that waitpid
  /// gives, -1 if unknown.
  int wait();

 private:
  pid_t process_ = -1;
  int end_ = -1;
  int status_ = -1;
};

/// Write to a socket; false if its other end is closed.
bool write_all(int end, const void* data, std::size_t size);

/// In a child: become a program found on PATH, without a shell, with these files as standard input, output and error.
/// Returns, with an exit status, only if that fails: 127 if there is no such program, else 126.
int become(const std::vector<std::string>& words, int input, int output, int error);

struct CommandResult {
  int status = -1;     // -1: not started, or killed
  std::string output;  // its stdout and stderr
};

/// Run a program found on PATH, without a shell, and wait for it.
CommandResult run_command(const std::vector<std::string>& words);

/// Run `work` in a child process and return its result; empty if the child crashed, was killed or `work` threw.
/// Memory of this process is not affected, and stderr of the child is discarded. `work` must not use threads started by
/// this process (OpenMP). Throws FileError if no process can be started, or if the child sleeps for `stall_s` without
/// using the processor (waiting for a disk does not count); it is then killed. `what`: name of the work in messages.
std::optional<std::string> output_of_child(const std::string& what, const std::function<std::string()>& work,
                                           double stall_s = 120);

/// Mutex that threads started by this process hold shared while they work. A child process starts only when none does,
/// since it would inherit a held lock permanently.
std::shared_mutex& work_beside();

}  // namespace plica
