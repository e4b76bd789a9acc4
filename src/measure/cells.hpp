// What is measured of single cells and of the whole sheet.
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

/// Mean speed of the cells' barycentres, um/s.
double mean_speed(const Tissue& tissue, const MonitoredCells& cells, const Vectors& velocities);

/// Mean displacement from rest of the cells' corner nodes, um: "the displacement of the nodes" of the paper.
double mean_node_displacement(const Tissue& tissue, const MonitoredCells& cells, const Vectors& positions);

/// Mean over the cells of apical area over apical area at rest.
double mean_apical_area_ratio(const Tissue& tissue, const MonitoredCells& cells, std::span<const Vec3> positions);

/// The smallest of all cells' apical areas over those at rest; empty where no cell has any.
std::optional<double> min_apical_area_ratio(const Tissue& tissue, std::span<const Vec3> positions);

/// How many apical edges of cells are shorter than a tenth of their length at rest, from corner to corner.
std::size_t short_edges(const Tissue& tissue, std::span<const Vec3> positions);

/// Activity of each cell: that of its program, delay included, in the first law by which it acts; 0 outside.
/// Profile and variation are no part of it.
std::vector<double> activities(const Model& model, const State& state);

/// The factor that profile and variation put on each cell, of the same law; 0 outside.
std::vector<double> strengths(const Model& model);

/// Who acts by a law, and how strongly; null for one by which no cell acts. Applied pressures count.
const CellPattern* pattern_of(const Law& law);

/// Volume enclosed by the basal surface, um^3; empty when that surface is not closed.
std::optional<double> lumen_volume(const Tissue& tissue, std::span<const Vec3> positions);

/// Volume inside the apical surface, cells and lumen, um^3; empty when that surface is not closed.
std::optional<double> volume_inside_apices(const Tissue& tissue, std::span<const Vec3> positions);

/// Deepest place of a node beyond an obstacle (outside the shell), um; 0 where none is.
double shell_penetration(const Model& model, std::span<const Vec3> positions);

/// Largest |V/V_target - 1| of a cell.
double max_volume_error(const Model& model, std::span<const Vec3> positions);

/// What the active laws exert on each node, nN, without their dampers.
Vectors active_forces(const Model& model, const State& state);

/// What pulls at the nodes of a body that stands still, nN: elasticity, contractions without their dampers, applied
/// pressures. No drag, no inertia; volumes and the shell, which balance these, are not in it.
Vectors driving_forces(const Model& model, const State& state);

/// The same of one law alone, active or not.
Vectors forces_of_law(const Model& model, const State& state, const Law& law);

/// Mean tension of the faces that each cortex acts on, by area, nN/um; with the cortex's label.
std::vector<std::pair<std::string, double>> mean_tensions(const Model& model, const State& state);

/// Unit normals of the cells' apical surfaces at rest, outward.
std::vector<Vec3> rest_apical_normals(const Tissue& tissue, std::span<const CellId> cells);

/// Mean of the vectors at a cell's apical corners.
Vec3 mean_apical(const Cell& cell, std::span<const Vec3> vectors);

}  // namespace plica
