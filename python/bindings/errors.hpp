// What C++ throws, as the exceptions of plica.errors.
#pragma once

#include <optional>
#include <string>

namespace plica::python {

/// From now on, errors of plica leave this module as those of plica.errors.
void translate_errors();

/// A simulation gave up.
struct GaveUp {
  std::string reason;
  std::optional<int> cell;
  double time_s;
};

}  // namespace plica::python
