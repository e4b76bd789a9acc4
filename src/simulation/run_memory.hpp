// Where a run is between two steps: what a checkpoint holds of it, and a fork in time takes along.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "mechanics/division.hpp"
#include "mechanics/model.hpp"
#include "simulation/controls.hpp"

namespace plica {

/// A division that has been made, and what the model's part in it depended on.
struct PastDivision {
  double time_s = 0;
  Vectors positions;  // nodes, before it; um
  std::vector<PlannedDivision> planned;
};

/// Where a run is, between two steps: with the model of the scenario, enough to go on to the same bits.
struct RunMemory {
  State state;
  int steps = 0;
  int divisions = 0;                         // cells that divided
  std::optional<double> equilibrium_time_s;  // first time that every node was slower than the limit
  bool at_equilibrium = false;               // now
  bool criterion_met = false;                // [stop] says that the run is over
  double wanted_step_s = 0;                  // length of the next step; 0: no step yet
  double computing_s = 0;                    // what its steps have taken, wall time
  std::vector<EnergyFlow> energies;          // of all steps so far, as energy_flows lists them; none before the first
  FactorMemory factor;
  std::vector<std::shared_ptr<const PastDivision>> past_divisions;
  std::vector<std::vector<double>> whole_internals;  // with mirror planes: what laws of the whole remember
};

/// Whether nothing is left to do.
bool has_ended(const RunMemory& run, const RunControls& controls);

/// A memory that is not one of the model that it is given to.
struct UnfitMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Whether it fits the model, which has the past divisions behind it: sizes, and numbers of nodes and cells. What is
/// wrong, or nothing.
std::optional<std::string> why_unfit(const RunMemory& run, const Model& model);
/// The same of a division that is to be made again.
std::optional<std::string> why_unfit(const PastDivision& past, const Model& model);

}  // namespace plica
