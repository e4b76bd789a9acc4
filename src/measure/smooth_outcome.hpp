// Output variables with gradients by node positions, for gradients of runs (docs/theory/gradients.md).
#pragma once

#include <string>

#include "measure/observation.hpp"

namespace plica {

struct SmoothOutcome {
  double value = 0;  // as in series.csv
  Vectors gradient;  // by positions; nodes
};

/// Return an output variable at given positions with its gradient: furrow_depth_um (that of the deepest point),
/// apical area ratios, heights, distance of the lips, enclosed and lumen volume ratios, or a monitor of positions,
/// displacements, distances, depths, areas or volumes; of an extremum that of the node or cell which has it.
/// UsageError, with the existing names, for others.
SmoothOutcome smooth_outcome(const std::string& name, const Model& model, const MeasurePlan& plan,
                             const Vectors& positions);

/// Whether such an output variable is relative to the reference state.
bool is_relative_to_rest(const std::string& name, const MeasurePlan& plan);

/// Add the gradient of sum w_c A_c, A_c being areas of cells on one side, as face_areas.
void add_area_gradient(const Tissue& tissue, CellSide side, std::span<const Vec3> positions,
                       std::span<const double> weights, std::span<Vec3> gradient);

}  // namespace plica
