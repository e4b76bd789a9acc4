// Background thread: compresses and writes files while the next step is solved.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace plica {

/// Queue of jobs, done in order on one background thread, or immediately if none is available. Jobs must not start a
/// child process (child_process.hpp). An exception of a job is rethrown once by the next `add`, `check` or `finish`;
/// later jobs are dropped.
class Background {
 public:
  /// `most_waiting`: largest number of queued jobs, which bounds the memory.
  explicit Background(std::size_t most_waiting);
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Finishes queued jobs unless one failed. Call `finish` before to receive its exception.
  ~Background();

  /// Queue a job; waits while the queue is full.
  void add(std::function<void()> job);

  /// Whether a job failed and its exception is still to be rethrown.
  [[nodiscard]] bool has_failed() const;

  /// Rethrow the exception of a failed job, if any.
  void check();

  /// Wait until all jobs are done.
  void finish();

  /// Processor time of the jobs so far, s.
  [[nodiscard]] double processor_s();

 private:
  void work();
  void throw_fault(std::unique_lock<std::mutex>& lock);

  const std::size_t most_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool started_ = false, at_work_ = false, ending_ = false, failed_ = false;
  std::exception_ptr fault_;  // not yet rethrown
  std::thread thread_;
};

}  // namespace plica
