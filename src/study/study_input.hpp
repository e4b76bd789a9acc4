// A study as its file says it: a scenario, keys that vary, a design of points, and what is kept of each run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/load.hpp"

namespace plica {

/// How a key varies: over values that are listed, or between two numbers, or as a normal distribution.
struct StudyKey {
  std::string key;                  // dotted, as in --set
  int line = 0;                     // of the study's file
  std::vector<std::string> values;  // in TOML; empty: from low to high
  double low = 0, high = 0;         // inf where a normal distribution has no bound
  bool is_log = false;              // evenly in the logarithm
  bool is_whole = false;            // takes whole numbers only
  std::optional<double> step;       // whole steps from low only
  std::optional<int> count;         // how many values a grid takes from low to high
  std::optional<double> mean, sd;   // normal
};

enum class DesignKind { grid, list, one_at_a_time, sobol, latin_hypercube, sobol_indices, file };

/// As in the study's file: "one-at-a-time".
const char* word_of(DesignKind kind);

/// What each run leaves beside its row: nothing, its summary.json, or all that `plica run` leaves.
enum class KeptOfRun { row, summary, full };

struct StudyInput {
  std::string name, file, text;  // of the study's own file
  ScenarioSource scenario;
  std::vector<std::string> overrides;  // [set], as of --set
  std::vector<int> override_lines;     // of the study's file
  std::vector<StudyKey> keys;
  DesignKind kind = DesignKind::grid;
  int points = 0;  // of designs that do not follow from the keys
  std::uint64_t seed = 1;
  int replicates = 1;
  std::string points_file;            // kind = "file"
  std::vector<std::string> measures;  // of summary.json; empty: all numbers
  KeptOfRun each = KeptOfRun::row;
  std::vector<Diagnostic> notes;  // what is allowed, and may not be meant
};

/// Whether a TOML text is a study's, not a scenario's.
bool is_study(const std::string& text);

/// Reads a study's file. Paths in it are relative to it. Throws FileError, or ScenarioError with all that is wrong.
StudyInput read_study(const std::string& file);
/// The same of a text; `file` is what messages call it, and where paths start.
StudyInput parse_study(const std::string& name, const std::string& file, const std::string& text);

}  // namespace plica
