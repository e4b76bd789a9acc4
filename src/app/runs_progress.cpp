#include "app/runs_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "core/words.hpp"

namespace plica {

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

}  // namespace plica
