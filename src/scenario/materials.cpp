#include "scenario/materials.hpp"

namespace plica {
namespace {

Vec3 mean(std::span<const NodeId> nodes, const Vectors& positions) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : nodes) sum += positions[node.index()];
  return sum / static_cast<double>(nodes.size());
}

// Height of the element's centre in its cell, reference state: 0 at the basal, 100 at the apical surface.
double height_percent(const Tissue& tissue, std::size_t element) {
  const Cell& cell = tissue.cells[tissue.element_cell[element].index()];
  const Vec3 base = mean(cell.basal_corners(), tissue.rest_positions);
  const Vec3 up = mean(cell.apical_corners(), tissue.rest_positions) - base;
  return 100 * (mean(tissue.elements[element], tissue.rest_positions) - base).dot(up) / up.squaredNorm();
}

}  // namespace

std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue) {
  std::vector<bool> result;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    bool is_in = cells[tissue.element_cell[e].index()];
    if (is_in && input.height_percent) {
      const double height = height_percent(tissue, e);
      is_in = height >= (*input.height_percent)[0] && height <= (*input.height_percent)[1];
    }
    result.push_back(is_in);
  }
  return result;
}

void put_material(const RegionElasticityInput& input, const ElasticityInput& common, const CellPattern& pattern,
                  const Tissue& tissue, std::vector<ElasticMaterial>& materials) {
  const std::vector<bool> chosen = elements_of(input, pattern.cells, tissue);
  const double modulus = input.young_modulus_Pa.value_or(common.young_modulus_Pa);
  for (std::size_t e = 0; e < materials.size(); ++e) {
    if (!chosen[e]) continue;
    materials[e].factor = modulus * pattern.strengths[tissue.element_cell[e].index()] / common.young_modulus_Pa;
    if (input.poisson_ratio) materials[e].poisson_ratio = *input.poisson_ratio;
    if (input.relaxation_s) materials[e].relaxation_s = *input.relaxation_s;
  }
}

}  // namespace plica
