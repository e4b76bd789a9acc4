// Measures of single cells and of the whole sheet.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "measure/furrow.hpp"
#include "mechanics/model.hpp"

namespace plica {

struct CellPattern;

/// Mean length of the four apico-basal edges, um.
double cell_height(const Cell& cell, std::span<const Vec3> positions);

/// Mean speed of the barycentres of cells, um/s.
double mean_speed(const Tissue& tissue, const MonitoredCells& cells, const Vectors& velocities);

/// Mean displacement of corner nodes from the reference state, um: "displacement of the nodes" of the paper.
double mean_node_displacement(const Tissue& tissue, const MonitoredCells& cells, const Vectors& positions);

double mean_apical_area_ratio(const Tissue& tissue, const MonitoredCells& cells, std::span<const Vec3> positions);

/// Smallest apical area / reference area of all cells; empty without apical faces.
std::optional<double> min_apical_area_ratio(const Tissue& tissue, std::span<const Vec3> positions);

/// Number of apical cell edges, corner to corner, shorter than a tenth of their reference length.
std::size_t short_edges(const Tissue& tissue, std::span<const Vec3> positions);

/// Activity (time course with delay) in the first law of each cell; cells, 0 outside. Excludes profile and variation.
std::vector<double> activities(const Model& model, const State& state);

/// Factor from profile and variation in that law; cells, 0 outside.
std::vector<double> strengths(const Model& model);

/// Volume enclosed by the basal surface, um^3; empty when that surface is not closed.
std::optional<double> lumen_volume(const Tissue& tissue, std::span<const Vec3> positions);

/// Volume inside the apical surface, cells and lumen, um^3; empty when that surface is not closed.
std::optional<double> volume_inside_apices(const Tissue& tissue, std::span<const Vec3> positions);

/// Largest distance of a node beyond an obstacle (outside the shell), um; 0 if there is none.
double shell_penetration(const Model& model, std::span<const Vec3> positions);

/// Volume of all cells, um^3.
double tissue_volume(const Model& model, std::span<const Vec3> positions);

/// Mean length of the apico-basal edges of all cells, um.
double mean_height(const Tissue& tissue, std::span<const Vec3> positions);

/// Largest distance of a node from its reference position, um.
double max_displacement(const Tissue& tissue, std::span<const Vec3> positions);

/// Largest |V/V_target - 1| of a cell.
double max_volume_error(const Model& model, std::span<const Vec3> positions);

/// Forces of active laws without their dampers, nN; nodes. These and the forces below are those of the present state
/// and memory of the laws; forces on hanging nodes act on the free nodes that carry them.
Vectors active_forces(const Model& model, const State& state);

/// Static driving forces, nN; nodes: elasticity, contractions without dampers, applied pressures. Excludes drag,
/// inertia, cell pressures and the shell, which balance them.
Vectors driving_forces(const Model& model, const State& state);

/// Static force of one law, active or not, nN; nodes.
Vectors forces_of_law(const Model& model, const State& state, const Law& law);

/// Identifier and area-weighted mean tension of each cortex, nN/um.
std::vector<std::pair<std::string, double>> mean_tensions(const Model& model, const State& state);

/// Outward unit normals of reference apical surfaces; cells.
std::vector<Vec3> rest_apical_normals(const Tissue& tissue, std::span<const CellId> cells);

/// Mean of the vectors at the apical corners of a cell.
Vec3 mean_apical(const Cell& cell, std::span<const Vec3> vectors);

}  // namespace plica
