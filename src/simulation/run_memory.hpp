// State of a run between two steps, as stored in checkpoints and copied by branches.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "mechanics/model.hpp"
#include "mechanics/model_memory.hpp"
#include "simulation/controls.hpp"

namespace plica {

/// State of a run between two steps. With the model of the scenario it determines the rest of the run bitwise.
struct RunMemory {
  State state;
  Observation measures;  // of the last accepted step, or of the reference state
  int steps = 0;
  int divisions = 0;                         // number of cells that divided
  std::optional<double> equilibrium_time_s;  // first time with all nodes below the stop speed
  bool at_equilibrium = false;               // at present
  double wanted_step_s = 0;                  // length of the next step; 0: no step yet
  int careful_steps = 0;                     // next steps that lengthen only little (StepLength::halve)
  Pace pace;                                 // until it is known, then from there on
  double computing_s = 0;                    // wall time of its steps
  std::vector<EnergyFlow> energies;  // sums over all steps, in the order of energy_flows; empty before the first
  std::shared_ptr<const ModelMemory> changes;        // what divisions made of the model; null before the first
  std::vector<double> growth_ends_s;                 // of daughters, after the last division; steps end on them
  std::vector<std::vector<double>> whole_internals;  // with mirror planes: internal variables of the full model
  std::map<std::string, CellArray> outside_arrays;   // cells (all, with mirror planes): set from outside for output
};

bool has_ended(const RunMemory& run, const RunControls& controls);

/// Error: the memory does not fit the model.
struct UnfitMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Check the memory against the model with its changes: sizes, numbers of nodes and cells, internal states of laws.
/// Returns the problem, or empty.
std::optional<std::string> why_unfit(const RunMemory& run, const Model& model);
std::optional<std::string> why_unfit(std::span<const std::vector<double>> internals, const Model& model);

}  // namespace plica
