#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <optional>
#include <string_view>

#include "core/units.hpp"
#include "core/words.hpp"

namespace plica {
namespace {

// Depth of the furrow or fold or, without one, the largest displacement.
std::string extent(const Observation& row) {
  const std::optional<double> depth = row["furrow_depth_um"];
  return fmt::format("{} {:6.2f} um", depth ? "depth" : "displacement",
                     depth.value_or(row["max_displacement_um"].value_or(0)));
}

double fastest_node(const Observation& row) { return row["max_node_speed_um_per_s"].value_or(0); }

constexpr unsigned patience_s = 3;
constexpr std::string_view what_is_done = "building the embryo ...", erased = "\r\033[K";

volatile std::sig_atomic_t is_said = 0;

void say(std::string_view text) {
  if (::write(STDERR_FILENO, text.data(), text.size()) > 0) is_said = 1;
}

std::string bar(double part) {
  constexpr std::size_t width = 24;
  const auto filled = static_cast<std::size_t>(part * width);
  return '[' + std::string(filled, '#') + std::string(width - filled, '.') + ']';
}

}  // namespace

LiveLine::LiveLine(bool quiet) : quiet_(quiet), on_terminal_(::isatty(STDERR_FILENO) != 0) {}

void LiveLine::show(const std::string& text, bool is_last) {
  const auto now = Clock::now();
  if (quiet_ || (!is_last && now - last_ < std::chrono::milliseconds(on_terminal_ ? 100 : 10'000))) return;
  last_ = now;
  // Clear to the end of the line, since the next line may be shorter.
  fmt::print(stderr, "{}{}{}", on_terminal_ ? "\r" : "", text, on_terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

void LiveLine::erase() const {
  if (!quiet_ && on_terminal_) fmt::print(stderr, "{}", erased);
}

void Progress::show(const Observation& row) {
  time_left_.add(line_.elapsed_s(), row.time_s(), fastest_node(row));
  const std::optional<double> left_s = time_left_.seconds();
  const double part = left_s ? line_.elapsed_s() / (line_.elapsed_s() + *left_s) : 0;
  line_.show(fmt::format("{} {:3.0f} %  t = {:>10}  {}  fastest node {:9.3g} um/min  {}", bar(part), 100 * part,
                         moment(row.time_s()), extent(row), fastest_node(row) / units::um_per_minute,
                         time_left_.text()));
}

void RunsProgress::show(std::size_t done, std::size_t lost) {
  if (done <= before_) return;
  const double part = static_cast<double>(done) / static_cast<double>(runs_);
  const double left_s = line_.elapsed_s() * static_cast<double>(runs_ - done) / static_cast<double>(done - before_);
  line_.show(fmt::format("{} {} of {} runs{}, {} left", bar(part), done, runs_,
                         lost > 0 ? fmt::format(", {} without result", lost) : "", duration(left_s)),
             done == runs_);
}

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
