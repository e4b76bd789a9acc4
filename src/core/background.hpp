// Background jobs: compress and write files while the next step is solved.
#pragma once

#include <atomic>
#include <functional>
#include <future>

namespace plica {

/// Jobs done in order beside the calling thread, or immediately if no thread is available. Jobs must not start a child
/// process (child_process.hpp). An exception of a job is rethrown once by the next `add` or `finish`; later jobs are
/// dropped.
class Background {
 public:
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Finishes its jobs unless one failed. Call `finish` before to receive its exception.
  ~Background();

  /// Start a job after those before it. They keep their memory until then, so finish them often.
  void add(std::function<void()> job);

  /// Whether a job failed and its exception is still to be rethrown.
  [[nodiscard]] bool has_failed() const { return has_failed_ && !is_told_; }

  /// Wait until all jobs are done.
  void finish();

  /// Processor time of the jobs so far, s.
  [[nodiscard]] double processor_s() const { return processor_s_; }

 private:
  void work(const std::shared_future<void>& before, const std::function<void()>& job);

  std::atomic<double> processor_s_ = 0;
  std::atomic<bool> has_failed_ = false;
  bool is_told_ = false;
  std::shared_future<void> last_;
};

}  // namespace plica
