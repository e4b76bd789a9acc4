// X display that VTK draws on.
#pragma once

#include <string>

namespace plica {

/// Working display: the one of DISPLAY, or an own virtual X server (Xvfb), which ends with this object or, however it
/// ends, this process.
class Display {
 public:
  /// Throws FileError with a remedy if there is none.
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }  // ":99"
  [[nodiscard]] bool is_ours() const { return server_ > 0; }

  /// Start an own X server instead of a display that responds but cannot draw. Throws FileError as above.
  void start_own();

 private:
  std::string name_;
  int server_ = 0;  // process id of Xvfb; 0: none
};

}  // namespace plica
