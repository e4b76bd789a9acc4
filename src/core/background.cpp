#include "core/background.hpp"

#include <pthread.h>

#include <ctime>
#include <system_error>
#include <utility>

#include "core/child_process.hpp"

namespace plica {

Background::Background(std::size_t most_waiting) : most_waiting_(most_waiting) {
  try {
    thread_ = std::thread([this] { work(); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return started_; });
  } catch (const std::system_error&) {
    // No thread is available: jobs run immediately.
  }
}

Background::~Background() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Background::add(std::function<void()> job) {
  if (!thread_.joinable()) {
    if (std::exchange(failed_, true)) return;
    job();
    failed_ = false;
    return;
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.size() < most_waiting_ || failed_; });
  throw_fault(lock);
  if (failed_) return;
  waiting_.push_back(std::move(job));
  changed_.notify_all();
}

bool Background::has_failed() const {
  const std::lock_guard lock(mutex_);
  return fault_ != nullptr;
}

void Background::check() {
  std::unique_lock lock(mutex_);
  throw_fault(lock);
}

void Background::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return waiting_.empty() && !at_work_; });
  throw_fault(lock);
}

double Background::processor_s() {
  clockid_t clock{};
  timespec time{};
  if (!thread_.joinable() || ::pthread_getcpuclockid(thread_.native_handle(), &clock) != 0 ||
      ::clock_gettime(clock, &time) != 0)
    return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void Background::throw_fault(std::unique_lock<std::mutex>& lock) {
  const std::exception_ptr fault = std::exchange(fault_, nullptr);
  if (!fault) return;
  lock.unlock();
  std::rethrow_exception(fault);
}

void Background::work() {
  std::unique_lock lock(mutex_);
  started_ = true;
  changed_.notify_all();
  while (true) {
    changed_.wait(lock, [&] { return !waiting_.empty() || ending_; });
    if (waiting_.empty()) return;
    const std::shared_lock busy(work_beside());
    std::function<void()> job = std::exchange(waiting_.front(), {});
    waiting_.pop_front();
    at_work_ = true;
    lock.unlock();
    std::exception_ptr fault;
    try {
      job();
    } catch (...) {
      fault = std::current_exception();
    }
    job = {};  // free its memory before taking the next
    lock.lock();
    at_work_ = false;
    if (fault) {
      fault_ = fault;
      failed_ = true;
      waiting_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace plica
