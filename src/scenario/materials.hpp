// What elements are made of: the tables [elasticity] and [elasticity.NAME], on a tissue.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Of an element.
struct ElasticMaterial {
  double factor = 1;  // on the Young's modulus of [elasticity]
  double poisson_ratio = 0;
  double relaxation_s = 0;  // 0: none
};

/// The elements of which a table speaks: of the cells of a set, those whose middle lies in its part of the height.
std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue);

/// Gives these elements what the table says; `pattern`: of the table, on the tissue.
void put_material(const RegionElasticityInput& input, const ElasticityInput& common, const CellPattern& pattern,
                  const Tissue& tissue, std::vector<ElasticMaterial>& materials);

}  // namespace plica
