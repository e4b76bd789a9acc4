// Points of a study: values of its keys for each run.
#pragma once

#include <string>
#include <vector>

#include "study/study_input.hpp"

namespace plica {

/// One run of a study.
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

}  // namespace plica
