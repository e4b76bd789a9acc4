// Per-element values, for cells whose elements differ (layers).
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Give every element the value of its cell.
template <class Value>
std::vector<Value> of_cells(const Tissue& tissue, const std::vector<Value>& values) {
  std::vector<Value> result;
  result.reserve(tissue.elements.size());
  for (const CellId cell : tissue.element_cell) result.push_back(values[cell.index()]);
  return result;
}

/// Give all elements one value, times the factor of the cell if factors are given.
template <class Value>
std::vector<Value> in_all_elements(const Tissue& tissue, const Value& value, const std::vector<double>& factors) {
  std::vector<Value> result(tissue.elements.size(), value);
  if (!factors.empty())
    for (std::size_t e = 0; e < result.size(); ++e) result[e] = factors[tissue.element_cell[e].index()] * value;
  return result;
}

/// Values per element, inherited with their cells.
template <class Value>
class ElementValues {
 public:
  ElementValues(const Tissue& tissue, std::vector<Value> values) : values_(std::move(values)) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      cells_.push_back({tissue.cells[c].first_element.index(), tissue.cells[c].element_count,
                        static_cast<int>(tissue.sheet.level_count(CellId(c)))});
  }

  const Value& operator[](std::size_t element) const { return values_[element]; }
  [[nodiscard]] const Value* data() const { return values_.data(); }

  /// Return values after a change. Cells of as many elements keep theirs; others take on each level that of its first
  /// element, since the elements of a level are alike where cells change.
  [[nodiscard]] std::vector<Value> after_division(const Tissue& tissue, const TissueChange& change) const {
    std::vector<Value> after(tissue.elements.size());
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const Cell& cell = tissue.cells[c];
      const auto& [first, count, levels] = cells_[change.origin[c].index()];
      const int a_level = cell.element_count / levels;
      for (int e = 0; e < cell.element_count; ++e)
        after[cell.first_element.index() + e] =
            values_[first + (count == cell.element_count ? e : e / a_level * (count / levels))];
    }
    return after;
  }

 private:
  std::vector<Value> values_;
  struct Elements {
    std::size_t first;
    int count, levels;
  };
  std::vector<Elements> cells_;
};

}  // namespace plica
