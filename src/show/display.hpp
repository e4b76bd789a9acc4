// X display that VTK draws on.
#pragma once

#include <memory>
#include <string>

#include "core/child_process.hpp"

namespace plica {

/// Working display: the one of DISPLAY, or an own virtual X server (Xvfb), which ends with this object or, however it
/// ends, this process.
class Display {
 public:
  /// Throws FileError with a remedy if there is none.
  Display();

  [[nodiscard]] const std::string& name() const { return name_; }  // ":99"
  [[nodiscard]] bool is_ours() const { return server_ != nullptr; }

  /// Start an own X server instead of a display that responds but cannot draw. Throws FileError as above.
  void start_own();

 private:
  std::string name_;
  std::unique_ptr<ChildProcess> server_;  // Xvfb
};

}  // namespace plica
