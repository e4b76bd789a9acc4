// The points of a study: which values its keys take, run by run.
#pragma once

#include <string>
#include <vector>

#include "study/study_input.hpp"

namespace plica {

/// One run of a study.
struct StudyPoint {
  int point = 0;                    // from 1 on: the place in the design
  int replicate = 1;                // from 1 on: the same place with other seeds
  std::vector<std::string> values;  // of the keys, in TOML
  std::vector<std::string> seeds;   // of replicates, as of --set
};

struct StudyDesign {
  std::vector<std::string> keys;
  std::vector<StudyPoint> runs;        // point by point, and its replicates
  std::vector<Diagnostic> notes = {};  // what is allowed, and may not be meant
};

/// The same for the same study, on any machine. FileError or ScenarioError for a file of points that is none.
StudyDesign design_of(const StudyInput& study);

/// The points of a CSV table that messages call `file`: a first line of keys, then a line a point. ScenarioError where
/// it is none.
StudyDesign design_of_points(const std::string& file, const std::string& text);

/// What a run says otherwise than the study's scenario: [set], its values, and its seeds. As of --set.
std::vector<std::string> overrides_of(const StudyInput& study, const StudyDesign& design, const StudyPoint& run);

/// Names its files: "000012", or "000012_2" where points are run more than once.
std::string name_of_run(const StudyPoint& run, bool has_replicates);

/// As points.csv, and back. FileError where a text is no such thing.
std::string points_csv(const StudyDesign& design);
StudyDesign points_of_csv(const std::string& text);

}  // namespace plica
