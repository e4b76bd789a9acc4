// What elements are made of, where the elements of a cell may differ: the layers of a cell.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "tissue/division.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// The value of its cell for every element.
template <class Value>
std::vector<Value> of_cells(const Tissue& tissue, const std::vector<Value>& values) {
  std::vector<Value> result;
  result.reserve(tissue.elements.size());
  for (const CellId cell : tissue.element_cell) result.push_back(values[cell.index()]);
  return result;
}

/// The same value for all elements, times the factor of the cell where factors are given.
template <class Value>
std::vector<Value> in_all_elements(const Tissue& tissue, const Value& value, const std::vector<double>& factors) {
  std::vector<Value> result(tissue.elements.size(), value);
  if (!factors.empty())
    for (std::size_t e = 0; e < result.size(); ++e) result[e] = factors[tissue.element_cell[e].index()] * value;
  return result;
}

/// A value an element, handed on with its cell.
template <class Value>
class OfElements {
 public:
  OfElements(const Tissue& tissue, std::vector<Value> values) : values_(std::move(values)) {
    for (const Cell& cell : tissue.cells) cells_.emplace_back(cell.first_element.index(), cell.element_count);
  }

  const Value& operator[](std::size_t element) const { return values_[element]; }
  [[nodiscard]] const Value* data() const { return values_.data(); }

  /// The elements of a cell that was there before have what they had. Those of a daughter have what her mother's first
  /// one had: cells whose elements differ do not divide.
  [[nodiscard]] std::vector<Value> after_division(const Tissue& tissue, const Division& division) const {
    std::vector<Value> after(tissue.elements.size());
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const Cell& cell = tissue.cells[c];
      const auto& [first, count] = cells_[division.origin[c].index()];
      for (int e = 0; e < cell.element_count; ++e)
        after[cell.first_element.index() + e] = values_[first + (count == cell.element_count ? e : 0)];
    }
    return after;
  }

 private:
  std::vector<Value> values_;
  std::vector<std::pair<std::size_t, int>> cells_;  // first element, and how many
};

}  // namespace plica
