// Translation of C++ exceptions into those of plica.errors.
#pragma once

#include <optional>
#include <string>

namespace plica::python {

/// Register the translation of exceptions that leave this module.
void translate_errors();

/// Solver failure of a simulation; raised as NumericsError.
struct GaveUp {
  std::string reason;
  std::optional<int> cell;
  double time_s;
};

}  // namespace plica::python
