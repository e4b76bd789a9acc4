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
  throw FileError("no process can be started: " + std::generic_category().message(error));
}

[[noreturn]] void run_child(const std::function<std::string()>& work, int pipe_end) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // ends with the parent, however that ends
  // The C library and the sanitizers tell of a crash on stderr; the parent says it better.
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDERR_FILENO);
#ifndef PLICA_FUZZED  // where a fuzzer's handlers are to tell
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
  } catch (...) {  // says itself by the status
  }
  ::_exit(status);  // without destructors and buffers, which are the parent's
}

// What the kernel says of a process: its state (a letter) and its processor time, in ticks.
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

/// Everything up to the end; empty on an error. Stalled: no answer, and the process has slept for that long.
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
    ::close(ends[0]);  // else writing would wait for ever for a parent that is gone
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
        fmt::format("{} stood still for {:.0f} s without using the processor, in a process of its own, which "
                    "was ended; try again, and tell us if it happens again",
                    what, stall_s));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
  return std::move(answer.output);
}

}  // namespace plica
