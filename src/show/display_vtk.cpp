#include <X11/Xlib.h>
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
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "show/display.hpp"

namespace plica {
namespace {

constexpr int most_seconds_to_start = 30;

bool answers(const std::string& name) {
  ::Display* display = XOpenDisplay(name.c_str());
  if (display == nullptr) return false;
  XCloseDisplay(display);
  return true;
}

[[noreturn]] void throw_no_screen(const std::string& why) {
  const char* named = std::getenv("DISPLAY");
  throw FileError(fmt::format("pictures need an X display: {}, and {}; apt-get install xvfb, or set DISPLAY",
                              named == nullptr || *named == '\0'
                                  ? std::string("DISPLAY is not set")
                                  : fmt::format("DISPLAY ({}) does not allow drawing", named),
                              why));
}

// Become the server, in the child process; it writes the number of its display to the socket.
int become_server(int end, int messages) {
  ::setpgid(0, 0);                     // Ctrl-C must not reach the server
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // lets it remove its socket and lock
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR);
  const std::string number = std::to_string(::dup(end));  // without O_CLOEXEC
  // -noreset: otherwise the server restarts when a window closes, and the next window may come too early.
  return become({"Xvfb", "-displayfd", number, "-screen", "0", "64x64x24", "-noreset", "-nolisten", "tcp"}, nothing,
                nothing, messages);
}

// Read the line that the server writes once it is ready; empty if it ends or takes too long.
std::string read_number(int pipe_end) {
  using Clock = std::chrono::steady_clock;
  const auto last = Clock::now() + std::chrono::seconds(most_seconds_to_start);
  std::string line;
  while (Clock::now() < last) {
    pollfd watched{pipe_end, POLLIN, 0};
    if (::poll(&watched, 1, 200) <= 0) continue;
    char letter = 0;
    const ssize_t count = ::read(pipe_end, &letter, 1);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return "";
    if (letter == '\n') return line;
    line += letter;
  }
  return "";
}

// Last messages of Xvfb, in one line.
std::string last_line(std::FILE* messages) {
  std::rewind(messages);
  std::string line;
  std::array<char, 512> text{};
  while (std::fgets(text.data(), text.size(), messages) != nullptr)
    if (text[0] != '\n') line = text.data();
  while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
  return line;
}

}  // namespace

Display::Display() {
  const char* named = std::getenv("DISPLAY");
  if (named != nullptr && *named != '\0' && answers(named))
    name_ = named;
  else
    start_own();
}

void Display::start_own() {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages(std::tmpfile(), std::fclose);
  if (messages == nullptr) throw_no_screen("Xvfb cannot be started");
  try {
    server_ = std::make_unique<ChildProcess>([&](int end) { return become_server(end, ::fileno(messages.get())); });
  } catch (const FileError&) {
    throw_no_screen("a process cannot be started");
  }
  const std::string number = read_number(server_->end());
  if (number.empty()) {
    server_->send(SIGTERM);
    const int status = server_->wait();
    server_.reset();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw_no_screen("Xvfb is not installed");
    const std::string said = last_line(messages.get());
    throw_no_screen("Xvfb did not start" + (said.empty() ? said : " (" + said + ")"));
  }
  name_ = ":" + number;
}

}  // namespace plica
