// Values of the elements of a tissue, from one value or from those of its cells.
#pragma once

#include "mechanics/elasticity/neo_hookean.hpp"

namespace plica::support {

/// The same value in all elements, times the factor of the cell if factors are given.
template <class Value>
std::vector<Value> in_elements(const Tissue& tissue, const Value& value, const std::vector<double>& factors = {}) {
  std::vector<Value> result(tissue.elements.size(), value);
  if (!factors.empty())
    for (std::size_t e = 0; e < result.size(); ++e) result[e] = factors[tissue.element_cell[e].index()] * value;
  return result;
}

/// Materials from those of the cells; no relaxation if none are given.
inline std::vector<NeoHookeanMaterial> materials_of(const Tissue& tissue, const std::vector<double>& shear_moduli,
                                                    const std::vector<double>& relaxation_s = {}) {
  std::vector<NeoHookeanMaterial> materials;
  for (const CellId cell : tissue.element_cell)
    materials.push_back({shear_moduli[cell.index()], relaxation_s.empty() ? 0 : relaxation_s[cell.index()]});
  return materials;
}

}  // namespace plica::support
