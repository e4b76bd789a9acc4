// Ctrl-C during C++ work while other Python threads run.
#pragma once

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>

namespace plica::python {

/// Collector of exceptions raised by Python signal handlers during C++ work. They run only in the main thread of
/// Python, when polled: here, at most every 50 ms, at negligible cost.
class Signals {
 public:
  /// Whether the work must stop. Called without the GIL.
  [[nodiscard]] bool have_come() {
    using Clock = std::chrono::steady_clock;
    if (raised_ || Clock::now() - last_ < std::chrono::milliseconds(50)) return raised_.has_value();
    const nanobind::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) raised_.emplace();
    last_ = Clock::now();
    return raised_.has_value();
  }
  /// Store an exception that stops the work. Called with the GIL.
  void raise_later(nanobind::python_error error) { raised_.emplace(std::move(error)); }
  /// Raise the stored exception after the work. Called with the GIL.
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
