#include "measure/bending_error.hpp"

#include <algorithm>
#include <cmath>

#include "measure/measure_set.hpp"

namespace plica {
namespace {

std::vector<double> face_area_ratios(const Tissue& tissue, CellSide side, std::span<const Vec3> positions) {
  std::vector<double> ratios = face_areas(tissue, side, positions), rest = rest_face_areas(tissue, side);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = rest[c] > 0 ? ratios[c] / rest[c] : 1;
  return ratios;
}

bool overbends(const Model& model) {
  return std::ranges::any_of(model.laws, [](const auto& law) { return law->overbends(); });
}

}  // namespace

std::optional<double> bending_error(const Model& model, std::span<const Vec3> positions) {
  constexpr double error_per_area_ratio = 0.14, least_bending = 1e-9;
  if (!overbends(model)) return std::nullopt;
  const Tissue& tissue = model.tissue;
  const std::vector<double> apical = face_area_ratios(tissue, CellSide::apical, positions),
                            basal = face_area_ratios(tissue, CellSide::basal, positions);
  double bending = 0, wrong = 0;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const double of_cell = std::abs(basal[c] - apical[c]);
    bending += of_cell;
    wrong += of_cell * error_per_area_ratio * of_cell / static_cast<double>(tissue.sheet.level_count(CellId(c)));
  }
  if (bending <= least_bending * static_cast<double>(tissue.cells.size())) return std::nullopt;
  return wrong / bending;
}

int elements_through_height(const Tissue& tissue) {
  std::size_t most = 1;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) most = std::max(most, tissue.sheet.level_count(CellId(c)));
  return static_cast<int>(most);
}

MeasureSet bending_set() {
  return set_of("bending", "corotational elasticity", [](const Subject& s) { return kept_if(overbends(s.model)); },
                {{"bending_error", InSummary::last,
                  "Estimated relative error of bending from few elements through the height; depth by one element may "
                  "err five times as much ([convergence](../developers/convergence.md#meshes-of-polygons)).",
                  of(bending_error)}});
}

}  // namespace plica
