// The X display that VTK draws on.
#pragma once

#include <string>

namespace plica {

/// A display that answers: the one that DISPLAY names, or an X server of our own without a screen (Xvfb), which ends
/// with this object, and with this process however that ends.
class Display {
 public:
  /// FileError, with what to do about it, when there is neither.
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }  // ":99"
  [[nodiscard]] bool is_ours() const { return server_ > 0; }

  /// Takes an X server of our own in the place of a display that answers and cannot draw. FileError as above.
  void start_own();

 private:
  std::string name_;
  int server_ = 0;  // process id of Xvfb; 0: none
};

}  // namespace plica
