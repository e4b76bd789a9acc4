// Progress of runs: a live line on a terminal, or a line every 10 s in a file.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include "measure/observation.hpp"
#include "record/time_left.hpp"

namespace plica {

class LiveLine {
 public:
  explicit LiveLine(bool quiet);
  /// Replace the line, not more often than one can read.
  void show(const std::string& text, bool is_last = false);
  void erase() const;

  [[nodiscard]] bool is_on_terminal() const { return on_terminal_; }
  [[nodiscard]] double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

class Progress {
 public:
  Progress(TimeLeft time_left, bool quiet) : time_left_(std::move(time_left)), line_(quiet) {}
  void show(const Observation& row);
  void finish() const { line_.erase(); }

 private:
  TimeLeft time_left_;
  LiveLine line_;
};

/// Number of finished runs and remaining time.
class RunsProgress {
 public:
  /// `before`: runs that were complete at the start or resumption.
  RunsProgress(std::size_t before, std::size_t runs, bool quiet) : before_(before), runs_(runs), line_(quiet) {}

  /// `lost`: runs that ended without a result.
  void show(std::size_t done, std::size_t lost = 0);
  void finish() const { line_.erase(); }

 private:
  std::size_t before_, runs_;
  LiveLine line_;
};

/// Notice "building the embryo ..." on standard error, printed once after 3 s if that is a terminal. The destructor
/// erases the line. Uses SIGALRM instead of a thread, since files are read in child processes.
class DelayedNotice {
 public:
  DelayedNotice();
  DelayedNotice(const DelayedNotice&) = delete;
  DelayedNotice& operator=(const DelayedNotice&) = delete;
  ~DelayedNotice();
};

}  // namespace plica
