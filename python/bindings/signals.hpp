// Ctrl-C within work for which Python runs on beside.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>

namespace plica::python {

/// What Python's signal handlers raise while C++ works. They run in Python's main thread only, when it asks: here, at
/// most every 50 ms, which costs nothing.
class Signals {
 public:
  /// Whether the work is to end. Called without Python's lock.
  [[nodiscard]] bool have_come() {
    using Clock = std::chrono::steady_clock;
    if (raised_ || Clock::now() - last_ < std::chrono::milliseconds(50)) return raised_.has_value();
    const nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) raised_.emplace();
    last_ = Clock::now();
    return raised_.has_value();
  }
  /// The work is to end for this. Called with the lock.
  void raise_later(nanobind::python_error error) { raised_.emplace(std::move(error)); }
  /// After the work, with the lock.
  void rethrow() {
    if (!raised_) return;
    nanobind::python_error error = std::move(*raised_);
    raised_.reset();
    throw error;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::optional<nanobind::python_error> raised_;
};

}  // namespace plica::python
