// Runs of `plica reproduce`, and figures measured from them.
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

inline constexpr double matrix_tolerance_um = 0.05;      // of a step, in the matrix of readings; chosen reading: 0.02
inline constexpr double fine_tolerance_um = 0.005;       // for error bars in time
inline constexpr int pill_along = 14, sphere_along = 7;  // contractile cells on the midline

/// Plan of all runs, longest first. Runs that this build does not support are in `skipped` with the reason.
struct Plan {
  std::vector<BatchRun> runs;
  std::map<std::string, std::string> skipped;  // id: reason
};
/// Make the plan. `quick`: few runs with coarse steps.
Plan make_plan(bool quick);

/// Runs of a plan in DIR that reached their planned end; other files are ignored.
class Results {
 public:
  Results(std::filesystem::path directory, const Plan& plan);
  [[nodiscard]] bool has(const std::string& id) const { return finished_.contains(id); }
  [[nodiscard]] std::filesystem::path folder(const std::string& id) const { return directory_ / "runs" / id; }

 private:
  std::filesystem::path directory_;
  std::set<std::string> finished_;
};

/// All measurements.
struct Measured {
  Figures figures;                          // for claims: chosen reading, mesh.*, demo.*, division.*, ...
  std::map<std::string, Figures> readings;  // by id: pill.* and sphere.*
  Onsets pill_onsets, sphere_onsets;
};

/// Measure the finished runs; failed and missing ones contribute nothing.
Measured measure(const Results& results);

}  // namespace plica
