#include "core/background.hpp"

#include <ctime>
#include <shared_mutex>
#include <system_error>
#include <utility>

#include "core/child_process.hpp"

namespace plica {
namespace {

double processor_s_of_this_thread() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Background::~Background() {
  if (last_.valid()) last_.wait();
}

void Background::add(std::function<void()> job) {
  if (has_failed()) finish();
  if (is_told_) return;
  try {
    last_ = std::async(std::launch::async, [this, before = last_, job] {
              work(before, job);
              processor_s_ = processor_s_ + processor_s_of_this_thread();
            }).share();
  } catch (const std::system_error&) {  // no thread is available
    finish();
    is_told_ = true;  // if the job throws
    job();
    is_told_ = false;
  }
}

void Background::finish() {
  const std::shared_future<void> last = std::exchange(last_, {});
  if (!last.valid()) return;
  last.wait();
  is_told_ = has_failed_;
  last.get();
}

void Background::work(const std::shared_future<void>& before, const std::function<void()>& job) try {
  if (before.valid()) before.get();
  const std::shared_lock busy(work_beside());
  job();
} catch (...) {
  has_failed_ = true;
  throw;
}

}  // namespace plica
