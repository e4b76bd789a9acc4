// Per-element values, for cells whose elements differ (layers).
#pragma once

#include <utility>
#include <vector>

#include "tissue/tissue.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

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
  [[nodiscard]] std::vector<Value> after_change(const Tissue& tissue, const TissueChange& change) const {
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
