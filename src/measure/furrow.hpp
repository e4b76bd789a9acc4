// Furrow measures: depth, lips, central (VML) and near-end (VCE) cells of the ventral midline. Pure functions of tissue
// and positions; definitions: docs/reference/measures.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "measure/cross_section.hpp"
#include "mechanics/model.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Cell with its mirror images; values are means over them.
using MonitoredCells = std::vector<CellId>;

/// Cells and points to measure, chosen from the reference state.
struct FurrowSites {
  CellSet contractile;                // cells of the furrow
  Vec3 outward = -Vec3::UnitZ();      // mean reference apical normal, in the plane y = 0; depth is opposite
  MonitoredCells vml;                 // centre of the midline
  MonitoredCells vce;                 // near its ends
  int midline_pairs = 0;              // contractile midline cells from an end to the centre
  std::vector<CellId> midline;        // cells on y = 0 with outward apical surfaces, anterior to posterior
  std::array<MaterialPoint, 2> lips;  // left, right: borders of the contractile cells at x = 0
  bool has_lips = false;
};

/// Choose the sites. `vce_from_end`: position of VCE in the contractile midline from its ends, 1 the last.
FurrowSites choose_furrow_sites(const Tissue& tissue, const CellSet& contractile, int vce_from_end);

/// Update the sites after a division: both daughters replace a cell; lips are material points and remain.
void follow_division(FurrowSites& sites, const Tissue& tissue, const TissueChange& change);

/// Largest inward distance of the apical midline of the furrow cells from the shell, minus the reference value, um;
/// empty without a midline.
std::optional<double> furrow_depth_um(const Tissue& tissue, const FurrowSites& sites, std::span<const Vec3> positions);

/// Point of this depth: the apical midline of the furrow cells at its deepest.
std::optional<SurfacePoint> deepest_point(const Tissue& tissue, const FurrowSites& sites,
                                          std::span<const Vec3> positions);

/// Distance of a place from the shell, opposite to `outward`, um; without a shell its distance from the origin along
/// it.
double inward_depth_um(const Tissue& tissue, const FurrowSites& sites, const Vec3& place);

/// Cross-section of the furrow at x = 0; missing values are empty.
struct LipShape {
  std::optional<double> depth_below_lips_um;         // from the mean of the lips to the furrow bottom
  std::optional<double> lip_distance_um;             // between the material lips
  std::optional<double> highest_points_distance_um;  // between the outermost points left and right of the midline
};

LipShape lip_shape(const Tissue& tissue, const FurrowSites& sites, std::span<const Vec3> positions);

/// Depth of the apical midline of each cell, mean over its points on y = 0, defined as in furrow_depth_um; cells, empty
/// without points.
std::vector<std::optional<double>> cell_depths_um(const Tissue& tissue, const FurrowSites& sites,
                                                  std::span<const CellId> cells, std::span<const Vec3> positions);

/// Waviness of the midline: root-mean-square deviation of the depths of contractile cells from a quartic polynomial in
/// reference x, over the middle half of their length. Empty with fewer than ten cells.
std::optional<double> midline_waviness_um(const Tissue& tissue, const FurrowSites& sites,
                                          std::span<const Vec3> positions);

}  // namespace plica
