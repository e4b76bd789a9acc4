// Points of a study: values of its keys for each run; and errors of its scenario, located in the study's file.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "study/study_input.hpp"

namespace plica {

struct StudyPoint {
  int point = 0;                    // number in the design, from 1
  int replicate = 1;                // same point with other seeds, from 1
  std::vector<std::string> values;  // keys, in TOML
  std::vector<std::string> seeds;   // of replicates, in the form of --set
};

struct StudyDesign {
  std::vector<std::string> keys;
  std::vector<StudyPoint> runs;        // point by point, and its replicates
  std::vector<Diagnostic> notes = {};  // allowed, but possibly not intended
};

/// Compute the design, identical on any machine. Throws FileError or ScenarioError for an invalid file of points.
StudyDesign design_of(const StudyInput& study);

/// Parse points from CSV: a line of keys, then one line per point. `file`: name in messages. Throws ScenarioError.
StudyDesign design_of_points(const std::string& file, const std::string& text);

/// Overrides of a run in the form of --set: [set], its values, its seeds.
std::vector<std::string> overrides_of(const StudyInput& study, const StudyDesign& design, const StudyPoint& run);

/// Name of the files of a run: "000012", or "000012_2" with replicates.
std::string name_of_run(const StudyPoint& run, bool has_replicates);

/// Convert to points.csv and back. Throws FileError for another text.
std::string points_csv(const StudyDesign& design);
StudyDesign points_of_csv(const std::string& text);

/// Relocate errors to the keys of [set] and [vary] that cause them.
ScenarioError in_study(const ScenarioError& error, const StudyInput& study);

/// Throw ScenarioError if a value of the design, or a bound of a key, has the wrong type or is out of range, whatever
/// the other values.
void require_values_of_keys(const StudyInput& study, const StudyDesign& design);

/// Throw ScenarioError if a listed value gives no valid scenario in any run. At least one run must be valid.
void require_usable_values(const StudyInput& study, const StudyDesign& design);

}  // namespace plica
