// Per-element values, for cells whose elements differ (layers).
#pragma once

#include <utility>
#include <vector>

#include "tissue/division.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Values per element, inherited with their cells.
template <class Value>
class ElementValues {
 public:
  ElementValues(const Tissue& tissue, std::vector<Value> values) : values_(std::move(values)) {
    for (const Cell& cell : tissue.cells) cells_.emplace_back(cell.first_element.index(), cell.element_count);
  }

  const Value& operator[](std::size_t element) const { return values_[element]; }
  [[nodiscard]] const Value* data() const { return values_.data(); }

  /// Return values after a division. Elements of existing cells keep theirs; those of a daughter take that of the
  /// first element of the mother, since cells with different elements do not divide.
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
  std::vector<std::pair<std::size_t, int>> cells_;  // first element and count
};

}  // namespace plica
