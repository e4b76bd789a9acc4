// What can be wrong with input, and with files. Numerical outcomes are values (solver/step_report.hpp), not exceptions.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace plica {

/// Text for one line of a terminal: control characters, which a scenario may hold in its texts and names, as in TOML
/// ("\\n", "\\u001B").
std::string printable(const std::string& text);

/// One thing that is wrong in a scenario, printed as `FILE:LINE: key: problem; remedy`.
struct Diagnostic {
  std::string file;     // path, built-in name, or "--set" for the command line
  int line = 0;         // 1-based; 0 where there is none
  std::string key;      // dotted key, or empty
  std::string problem;  // what is wrong
  std::string remedy;   // what would be right

  [[nodiscard]] std::string text() const;  // one line
};

/// Everything that is wrong with a scenario, all at once. Exit status 2.
class ScenarioError : public std::runtime_error {
 public:
  explicit ScenarioError(std::vector<Diagnostic> diagnostics);
  [[nodiscard]] const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The program was called wrongly. Exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be read or written. Exit status 4.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plica
