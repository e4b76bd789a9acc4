// Errors of input and files. Failures of the solver are values (StepReport), not exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace plica {

/// Escape control characters, which texts and names of a scenario may contain, as in TOML ("\\n", "\\u001B").
std::string printable(const std::string& text);

/// Problem of a scenario, printed as `FILE:LINE: key: problem; remedy`.
struct Diagnostic {
  std::string file;     // path, built-in name, or "--set" for the command line
  int line = 0;         // 1-based; 0 if unknown
  std::string key;      // dotted key, or empty
  std::string problem;  // what was found
  std::string remedy;   // how to correct it

  [[nodiscard]] std::string text() const;  // one line
};

/// Error with all problems of a scenario. Exit status 2.
class ScenarioError : public std::runtime_error {
 public:
  explicit ScenarioError(std::vector<Diagnostic> diagnostics);
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// Error in the arguments of a call. Exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Error while reading or writing a file. Exit status 4.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plica
