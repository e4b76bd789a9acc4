#include "core/child_process.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
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

/// Everything up to the end; empty on an error.
std::optional<std::string> read_all(int pipe_end) {
  std::string output, block(1 << 16, '\0');
  while (true) {
    const ssize_t count = ::read(pipe_end, block.data(), block.size());
    if (count == 0) return output;
    if (count < 0 && errno != EINTR) return {};
    if (count > 0) output.append(block, 0, static_cast<std::size_t>(count));
  }
}

}  // namespace

std::shared_mutex& work_beside() {
  static std::shared_mutex mutex;
  return mutex;
}

std::optional<std::string> output_of_child(const std::function<std::string()>& work) {
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
  std::optional<std::string> output = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return {};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
  return output;
}

}  // namespace plica
