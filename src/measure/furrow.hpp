// The furrow, measured: depth, lips, and the cells at the middle (VML) and near the ends (VCE) of the ventral midline.
// Pure functions of tissue and positions; what every word means stands in docs/reference/measures.md.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "measure/surface_cut.hpp"
#include "mechanics/model.hpp"
#include "tissue/division.hpp"

namespace plica {

/// A monitored cell together with its mirror images: values are their means.
using MonitoredCells = std::vector<CellId>;

/// What is measured, chosen once from the tissue at rest.
struct FurrowSites {
  CellSet contractile;                // the cells whose furrow is measured
  Vec3 outward = -Vec3::UnitZ();      // their mean apical normal at rest, in the plane y = 0; depth is against it
  MonitoredCells vml;                 // centre of the midline
  MonitoredCells vce;                 // near its ends
  int midline_pairs = 0;              // contractile midline cells from an end to the middle
  std::vector<CellId> midline;        // cells on y = 0 whose apices face outward, anterior to posterior
  std::array<MaterialPoint, 2> lips;  // left, right: where the mid cross-section leaves the contractile cells
  bool has_lips = false;
};

/// `vce_from_end`: VCE is this cell of the contractile midline counted from its ends, 1 the last.
FurrowSites choose_furrow_sites(const Tissue& tissue, const CellSet& contractile, int vce_from_end);

/// The same sites after a division: of a monitored cell both daughters. Lips are nodes and stay.
void follow_division(FurrowSites& sites, const Tissue& tissue, const Division& division);

/// Everything about the furrow at one moment. What has no value is empty.
struct FurrowShape {
  std::optional<double> depth_um;             // from the shell to the midline, less what flat facets have at rest
  std::optional<double> depth_below_lips_um;  // from the lips' mean height down to the floor in the mid cross-section
  std::optional<double> lip_distance_um;      // between the material lips
  std::optional<double> highest_points_distance_um;  // between the outermost points left and right of the midline
};

FurrowShape furrow_shape(const Tissue& tissue, const FurrowSites& sites, std::span<const Vec3> positions);

/// Depth of each cell's apical midline, mean over its points on y = 0; as furrow_shape's for the whole furrow. Empty
/// where a cell has none.
std::vector<std::optional<double>> cell_depths_um(const Tissue& tissue, const FurrowSites& sites,
                                                  std::span<const CellId> cells, std::span<const Vec3> positions);

/// How much the midline goes up and down along the furrow: the root mean square of how far its contractile cells'
/// depths are from a polynomial of the fourth degree in x at rest, over the middle half of their length. Empty where
/// fewer than ten cells lie there.
std::optional<double> midline_waviness_um(const Tissue& tissue, const FurrowSites& sites,
                                          std::span<const Vec3> positions);

}  // namespace plica
