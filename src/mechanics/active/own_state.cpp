#include "mechanics/active/own_state.hpp"

#include <algorithm>

namespace plica {

OwnState::OwnState(const Tissue& tissue, const OwnStateRule& rule) : rule_(rule), at_rest_(tissue.cells.size(), 0.0) {
  if (!is_used()) return;
  if (rule.measure == OwnMeasure::height_ratio) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const Cell& cell = tissue.cells[c];
      auto& edges = edges_.emplace_back();
      for (int i = 0; i < 4; ++i) {
        edges[i] = {cell.corners[i], cell.corners[i + 4]};
        at_rest_[c] += 0.25 * (cell.rest_shape[i + 4] - cell.rest_shape[i]).norm();
      }
    }
    return;
  }
  facets_ = rule.measure == OwnMeasure::apical_area_ratio ? tissue.apical_facets : tissue.basal_facets;
  for (const Facet& facet : facets_) at_rest_[facet.cell.index()] += facet_area(rest_corners(tissue, facet));
}

std::vector<double> OwnState::sizes(std::span<const Vec3> x) const {
  std::vector<double> sizes(at_rest_.size(), 0.0);
  for (const Facet& facet : facets_) sizes[facet.cell.index()] += facet_area(gather(x, facet));
  for (std::size_t c = 0; c < edges_.size(); ++c)
    for (const auto& [base, apex] : edges_[c]) sizes[c] += 0.25 * (x[apex.index()] - x[base.index()]).norm();
  return sizes;
}

std::vector<double> OwnState::ratios(std::span<const Vec3> positions) const {
  std::vector<double> ratios = sizes(positions);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = at_rest_[c] > 0 ? ratios[c] / at_rest_[c] : 1;
  return ratios;
}

std::vector<double> OwnState::numbers(std::span<const Vec3> positions, double time_s,
                                      std::span<const double> before) const {
  if (!is_used()) return {};
  std::vector<double> numbers = ratios(positions);
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const double ratio = numbers[c];
    if (!starts()) {
      numbers[c] = std::clamp((ratio - rule_.from) / (rule_.to - rule_.from), 0.0, 1.0);
    } else if (!before.empty() && before[c] != not_yet) {
      numbers[c] = before[c];
    } else {
      const bool has_come =
          rule_.kind == OwnStateRule::Kind::starts_below ? ratio < rule_.threshold : ratio > rule_.threshold;
      numbers[c] = has_come ? time_s : not_yet;
    }
  }
  return numbers;
}

}  // namespace plica
