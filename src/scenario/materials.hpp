// Elastic properties of elements, from [elasticity] and [elasticity.NAME].
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Elastic properties of one element.
struct ElasticMaterial {
  double factor = 1;  // on the Young's modulus of [elasticity]
  double poisson_ratio = 0;
  double relaxation_s = 0;  // 0: none
};

/// Elements affected by a table: those of `cells` with their centre in `height_percent`. One entry per element.
std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue);

/// Overwrites `materials` of the affected elements; `pattern` is that of the table on this tissue.
void put_material(const RegionElasticityInput& input, const ElasticityInput& common, const CellPattern& pattern,
                  const Tissue& tissue, std::vector<ElasticMaterial>& materials);

}  // namespace plica
