#include "core/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <limits>
#include <mutex>
#include <system_error>

#include "core/errors.hpp"

namespace plica {
namespace {

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
struct ChildOutput {
  std::optional<std::string> output;
  bool stalled = false;
};
ChildOutput read_all(int pipe_end, pid_t child, double stall_s) {
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

ChildProcess::ChildProcess(const std::function<int(int end)>& work) {
  std::array<int, 2> ends{-1, -1};
  const pid_t parent = ::getpid();
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0) process_ = ::fork();
  if (process_ < 0) {
    const int error = errno;
    for (const int end : ends) ::close(end);
    throw FileError("cannot start a process: " + std::generic_category().message(error));
  }
  if (process_ > 0) {
    ::close(ends[1]);
    end_ = ends[0];
    return;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::close(ends[0]);  // otherwise writing would wait forever once the parent is gone
  int status = 1;
  try {
    status = work(ends[1]);
  } catch (...) {  // reported by the exit status
  }
  ::_exit(status);
}

ChildProcess::~ChildProcess() {
  send(SIGTERM);
  wait();
}

void ChildProcess::send(int signal) const {
  if (process_ > 0) ::kill(process_, signal);
}

int ChildProcess::wait() {
  if (process_ < 0) return status_;
  ::close(end_);
  const auto start = std::chrono::steady_clock::now();
  while (true) {
    const pid_t ended = ::waitpid(process_, &status_, WNOHANG);
    if (ended == process_ || (ended < 0 && errno != EINTR)) break;
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(30)) send(SIGKILL);
    ::poll(nullptr, 0, 2);
  }
  process_ = -1;
  return status_;
}

bool write_all(int end, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::send(end, at, size, MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written, size -= static_cast<std::size_t>(written);
  }
  return true;
}

int become(const std::vector<std::string>& words, int input, int output, int error) {
  std::vector<const char*> arguments;
  for (const std::string& word : words) arguments.push_back(word.c_str());
  arguments.push_back(nullptr);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(error, STDERR_FILENO);
  ::execvp(arguments.front(), const_cast<char* const*>(arguments.data()));
  return errno == ENOENT ? 127 : 126;
}

CommandResult run_command(const std::vector<std::string>& words) {
  ChildProcess child([&](int end) { return become(words, ::open("/dev/null", O_RDONLY), end, end); });
  CommandResult result;
  result.output = read_all(child.end(), child.id(), std::numeric_limits<double>::infinity()).output.value_or("");
  const int waited = child.wait();
  if (WIFEXITED(waited) && WEXITSTATUS(waited) < 126) result.status = WEXITSTATUS(waited);
  return result;
}

std::optional<std::string> output_of_child(const std::string& what, const std::function<std::string()>& work,
                                           double stall_s) {
  std::unique_lock nobody_works(work_beside());
  ChildProcess child([&](int end) {
    // The C library and sanitizers report crashes on stderr; the parent gives a better message.
    ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
#ifndef PLICA_FUZZED  // fuzzers need their own handlers
    for (const int fatal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fatal, SIG_DFL);
#endif
    const std::string output = work();
    return write_all(end, output.data(), output.size()) ? 0 : 1;
  });
  nobody_works.unlock();
  ChildOutput answer = read_all(child.end(), child.id(), stall_s);
  if (answer.stalled) {
    child.send(SIGKILL);
    throw FileError(
        fmt::format("{} made no progress for {:.0f} s; its process "
                    "was terminated; retry, and open an issue if it recurs",
                    what, stall_s));
  }
  if (child.wait() != 0) return {};
  return std::move(answer.output);
}

}  // namespace plica
