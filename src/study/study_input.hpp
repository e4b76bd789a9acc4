// Input of a study: scenario, varied keys, design of points, and files kept of each run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/load.hpp"

namespace plica {

/// Variation of a key: listed values, a range, or a normal distribution.
struct StudyKey {
  std::string key;                  // dotted, as in --set
  int line = 0;                     // in the study's file
  std::vector<std::string> values;  // in TOML; empty: from low to high
  double low = 0, high = 0;         // infinite for an unbounded normal distribution
  bool is_log = false;              // uniform in the logarithm
  bool is_whole = false;            // integer key
  std::optional<double> step;       // multiples of it from low
  std::optional<int> count;         // number of grid values from low to high
  std::optional<double> mean, sd;   // normal
};

enum class DesignKind { grid, list, one_at_a_time, sobol, latin_hypercube, sobol_indices, file };

/// Word in the study's file: "one-at-a-time".
const char* word_of(DesignKind kind);

/// Files kept of each run besides its row: none, summary.json, or all files of `plica run`.
enum class KeptOfRun { row, summary, full };

struct StudyInput {
  std::string name, file, text;  // of the study's own file
  ScenarioSource scenario;
  std::vector<std::string> overrides;  // [set], in the form of --set
  std::vector<int> override_lines;     // of the study's file
  std::vector<StudyKey> keys;
  DesignKind kind = DesignKind::grid;
  int points = 0;  // for designs whose size does not follow from the keys
  std::uint64_t seed = 1;
  int replicates = 1;
  std::string points_file;            // kind = "file"
  std::vector<std::string> measures;  // of summary.json; empty: all numbers
  KeptOfRun each = KeptOfRun::row;
  std::vector<Diagnostic> notes;  // allowed, but possibly not intended
};

/// Whether a TOML text is a study rather than a scenario.
bool is_study(const std::string& text);

/// Read a study's file; paths in it are relative to it. Throws FileError, or ScenarioError with all problems.
StudyInput read_study(const std::string& file);
/// Parse the text of a study. `file`: name in messages and base of relative paths.
StudyInput parse_study(const std::string& name, const std::string& file, const std::string& text);

}  // namespace plica
