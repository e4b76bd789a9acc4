#include "app/delayed_notice.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace plica {
namespace {

constexpr unsigned patience_s = 3;
constexpr std::string_view what_is_done = "building the embryo ...", erased = "\r\033[K";

volatile std::sig_atomic_t is_said = 0;

void say(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) > 0) is_said = 1;
}

}  // namespace

DelayedNotice::DelayedNotice() {
  if (::isatty(STDERR_FILENO) == 0) return;
  std::signal(SIGALRM, [](int) { say(what_is_done); });
  ::alarm(patience_s);
}

DelayedNotice::~DelayedNotice() {
  ::alarm(0);
  if (is_said != 0) say(erased);
  is_said = 0;
}

}  // namespace plica
