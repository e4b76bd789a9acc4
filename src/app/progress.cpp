#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
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

}  // namespace

Progress::Progress(const RunControls& controls, bool quiet)
    : controls_(controls), quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0) {}

// Towards the end of time or, as speeds decay exponentially, towards rest: whichever is nearer.
double Progress::part_done(const Observation& row) const {
  double part = row.time_s() / controls_.end_s;
  const double speed = fastest_node(row), goal = controls_.equilibrium_speed_um_per_s;
  if (controls_.stop_at_equilibrium && goal > 0 && speed > goal && fastest_um_per_s_ > speed)
    part = std::max(part, std::log(fastest_um_per_s_ / speed) / std::log(fastest_um_per_s_ / goal));
  return std::clamp(part, 0.0, 1.0);
}

void Progress::show(const Observation& row) {
  fastest_um_per_s_ = std::max(fastest_um_per_s_, fastest_node(row));
  if (quiet_) return;
  const auto now = Clock::now();
  const double since_last_s = std::chrono::duration<double>(now - last_).count();
  if (since_last_s < (on_terminal_ ? 0.1 : 10.0)) return;
  last_ = now;
  const double part = part_done(row), elapsed_s = std::chrono::duration<double>(now - start_).count();
  const std::string left = part > 0.02 ? fmt::format("{:.0f} s left", elapsed_s * (1 - part) / part) : "";
  constexpr int width = 24;
  const int filled = static_cast<int>(std::lround(part * width));
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  const std::string line =
      fmt::format("[{}] {:3.0f} %  t = {:>10}  {}  fastest node {:9.3g} um/min  {}", bar, 100 * part,
                  moment(row.time_s()), extent(row), fastest_node(row) / units::um_per_minute, left);
  // Clear to the end of the line, since the next line may be shorter.
  fmt::print(stderr, "{}{}{}", on_terminal_ ? "\r" : "", line, on_terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

void Progress::finish() {
  if (!quiet_ && on_terminal_) fmt::print(stderr, "\r\033[K");
}

RunsProgress::RunsProgress(std::size_t before, std::size_t runs, bool quiet)
    : before_(before), runs_(runs), quiet_(quiet), on_terminal_(::isatty(STDERR_FILENO) != 0) {}

void RunsProgress::show(std::size_t done, std::size_t lost) {
  const auto time = Clock::now();
  const auto pause = std::chrono::milliseconds(on_terminal_ ? 100 : 10'000);
  if (quiet_ || done <= before_ || (time - last_ < pause && done < runs_)) return;
  last_ = time;
  const double elapsed_s = std::chrono::duration<double>(time - start_).count();
  const double left_s = elapsed_s * static_cast<double>(runs_ - done) / static_cast<double>(done - before_);
  constexpr std::size_t width = 24;
  const std::size_t filled = width * done / runs_;
  fmt::print(stderr, "{}[{}{}] {} of {} runs{}, {} left{}", on_terminal_ ? "\r" : "", std::string(filled, '#'),
             std::string(width - filled, '.'), done, runs_, lost > 0 ? fmt::format(", {} without result", lost) : "",
             duration(left_s), on_terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

void RunsProgress::finish() const {
  if (!quiet_ && on_terminal_) fmt::print(stderr, "\r\033[K");
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
