#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

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

}  // namespace plica
