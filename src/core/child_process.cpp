#include "core/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <mutex>
#include <string_view>
#include <system_error>

#include "core/errors.hpp"

namespace plica {
namespace {

[[noreturn]] void throw_unstarted(int error) {
  throw FileError("cannot start a process: " + std::generic_category().message(error));
}

[[noreturn]] void run_child(const std::function<std::string()>& work, int pipe_end) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // end with the parent, however it ends
  // The C library and sanitizers report crashes on stderr; the parent gives a better message.
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDERR_FILENO);
#ifndef PLICA_FUZZED  // fuzzers need their own handlers
  for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fatal, SIG_DFL);
#endif
  int status = 1;
  try {
    const std::string output = work();
    std::string_view rest = output;
    while (!rest.empty()) {
      const ssize_t written = ::write(pipe_end, rest.data(), rest.size());
      if (written < 0 && errno != EINTR) break;
      if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
    }
    if (rest.empty()) status = 0;
  } catch (...) {  // reported by the exit status
  }
  ::_exit(status);  // without destructors and buffers, which are the parent's
}

// State (a letter) and processor time (ticks) of a process, from the kernel.
struct Activity {
  char state = 'R';
  unsigned long long ticks = 0;
};

Activity activity_of(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string word;
  while (file >> word && !word.ends_with(')')) {
  }
  Activity now;
  unsigned long long user = 0, system = 0;
  file >> now.state;
  for (int field = 4; field < 14; ++field) file >> word;
  if (file >> user >> system) now.ticks = user + system;
  return now;
}

/// Read to the end; empty on an error. Stalled: no output while the process sleeps for `stall_s`.
struct Answer {
  std::optional<std::string> output;
  bool stalled = false;
};
Answer read_all(int pipe_end, pid_t child, double stall_s) {
  using Clock = std::chrono::steady_clock;
  std::string output, block(1 << 16, '\0');
  Clock::time_point last_sign = Clock::now();
  unsigned long long ticks = 0;
  while (true) {
    pollfd waits_for{pipe_end, POLLIN, 0};
    if (::poll(&waits_for, 1, 1000) == 0) {
      const Activity now = activity_of(child);
      if (now.state != 'S' || now.ticks != ticks) last_sign = Clock::now();
      ticks = now.ticks;
      if (std::chrono::duration<double>(Clock::now() - last_sign).count() > stall_s) return {{}, true};
      continue;
    }
    const ssize_t count = ::read(pipe_end, block.data(), block.size());
    if (count == 0) return {output};
    if (count < 0 && errno != EINTR) return {};
    if (count > 0) output.append(block, 0, static_cast<std::size_t>(count));
    last_sign = Clock::now();
  }
}

}  // namespace

std::shared_mutex& work_beside() {
  static std::shared_mutex mutex;
  return mutex;
}

std::optional<std::string> output_of_child(const std::string& what, const std::function<std::string()>& work,
                                           double stall_s) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw_unstarted(errno);
  std::unique_lock nobody_works(work_beside());
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    for (const int end : ends) ::close(end);
    throw_unstarted(error);
  }
  if (child == 0) {
    ::close(ends[0]);  // otherwise writing would wait forever once the parent is gone
    run_child(work, ends[1]);
  }
  nobody_works.unlock();
  ::close(ends[1]);
  Answer answer = read_all(ends[0], child, stall_s);
  ::close(ends[0]);
  if (answer.stalled) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return {};
  if (answer.stalled)
    throw FileError(
        fmt::format("{} made no progress for {:.0f} s; its process "
                    "was terminated; retry, and open an issue if it recurs",
                    what, stall_s));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
  return std::move(answer.output);
}

}  // namespace plica
