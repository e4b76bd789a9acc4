// Work beside the computation: writing and compressing while the next step is solved.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace plica {

/// Does jobs one after another, in the order given, on a thread of its own. (Where no thread can be had, each is done
/// at once.) No job may start a child process (child_process.hpp). What a job throws is thrown again by the next `add`,
/// `check` or `finish`, once; jobs after it are not done.
class Background {
 public:
  /// At most `most_waiting` jobs wait beside the one being done: memory stays bounded.
  explicit Background(std::size_t most_waiting);
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Does what still waits, unless a job failed. Call `finish` before, to hear of that.
  ~Background();

  /// Waits for a place, then hands the job over.
  void add(std::function<void()> job);

  /// Whether a job failed and nobody has been told.
  [[nodiscard]] bool has_failed() const;

  /// Throws what a job threw.
  void check();

  /// Waits until every job is done.
  void finish();

  /// Processor time that the jobs have taken so far, s.
  [[nodiscard]] double processor_s();

 private:
  void work();
  void throw_fault(std::unique_lock<std::mutex>& lock);

  const std::size_t most_waiting_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool started_ = false, at_work_ = false, ending_ = false, failed_ = false;
  std::exception_ptr fault_;  // not yet told
  std::thread thread_;
};

}  // namespace plica
