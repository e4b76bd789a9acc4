// The runs that `plica reproduce` makes, and the figures taken from them.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "paper/measures.hpp"
#include "paper/readings.hpp"
#include "study/run_batch.hpp"

namespace plica {

inline constexpr double matrix_tolerance_um = 0.05;  // of a step, in the matrix of readings; the chosen reading's: 0.02
inline constexpr double fine_tolerance_um = 0.005;   // for the error bars in time
inline constexpr int pill_along = 14, sphere_along = 7;  // contractile cells on the midline

/// All runs, those that take longest first. What this build of plica does not know is left out and named in `skipped`
/// with the reason. `quick`: a few of them, coarsely.
struct Plan {
  std::vector<BatchRun> runs;
  std::map<std::string, std::string> skipped;  // id: why
};
Plan make_plan(bool quick);

/// The runs of a plan in DIR, as far as they came to their planned end. What else lies there is not looked at.
class Results {
 public:
  Results(std::filesystem::path directory, const Plan& plan);
  [[nodiscard]] bool has(const std::string& id) const { return finished_.contains(id); }
  [[nodiscard]] std::filesystem::path folder(const std::string& id) const { return directory_ / "runs" / id; }

 private:
  std::filesystem::path directory_;
  std::set<std::string> finished_;
};

/// What was measured in all.
struct Measured {
  Figures figures;                          // for the claims: of the chosen reading, mesh.*, demo.*, division.*, ...
  std::map<std::string, Figures> readings;  // by id: pill.* and sphere.*
  Onsets pill_onsets, sphere_onsets;
};

/// From the finished runs; of those that failed or were not made, nothing.
Measured measure(const Results& results);

}  // namespace plica
