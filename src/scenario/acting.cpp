#include "scenario/acting.hpp"

#include "scenario/words.hpp"

namespace plica {
namespace {

template <class Acting>
CellPattern pattern_of(const Acting& input, const Tissue& tissue) {
  PatternRule pattern;
  const ProfileInput& profile = input.profile;
  pattern.profile.shape = meaning_of(words::profile_shapes, profile.shape, pattern.profile.shape);
  pattern.profile.axis = meaning_of(words::profile_axes, profile.axis, pattern.profile.axis);
  pattern.profile.in_cells = profile.sigma_cells || profile.full_cells;
  pattern.profile.half_width = profile.full_cells ? 0.5 * *profile.full_cells : profile.half_width_um.value_or(1);
  pattern.profile.sigma = profile.sigma_cells.value_or(profile.sigma_um.value_or(1));
  pattern.profile.fade = profile.fade_cells.value_or(0);
  pattern.middle = profile.middle.value_or(1);
  pattern.edge = profile.edge.value_or(0);
  if (!profile.about.empty()) pattern.about = tissue.regions.at(profile.about);
  pattern.taper = {profile.full_length_um.value_or(0), profile.fade_um.value_or(0)};
  pattern.delay.speed = input.delay.speed_um_per_s.value_or(0);
  pattern.delay.axis = meaning_of(words::delay_axes, input.delay.axis, pattern.delay.axis);
  pattern.delay.from = meaning_of(words::delay_starts, input.delay.from, pattern.delay.from);
  pattern.spread = input.variation.spread;
  pattern.seed = static_cast<std::uint64_t>(input.variation.seed);
  return cell_pattern(tissue, tissue.regions.at(input.region), pattern);
}

}  // namespace

CellPattern make_pattern(const ContractionInput& input, const Tissue& tissue) { return pattern_of(input, tissue); }
CellPattern make_pattern(const CortexInput& input, const Tissue& tissue) { return pattern_of(input, tissue); }

std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue) {
  const auto inside = [](const std::optional<Range>& range, double value) {
    // A face given by its place, [a, a], holds the nodes on it despite rounding.
    return !range || (value >= (*range)[0] - 1e-9 && value <= (*range)[1] + 1e-9);
  };
  const CellSet& cells = tissue.regions.at(input.region);
  std::vector<bool> held(tissue.node_count(), false);
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    if (!cells[tissue.element_cell[e].index()]) continue;
    for (const NodeId node : tissue.elements[e]) {
      const Vec3& x = tissue.rest_positions[node.index()];
      if (inside(input.x_um, x.x()) && inside(input.y_um, x.y()) && inside(input.z_um, x.z()))
        held[node.index()] = true;
    }
  }
  return held;
}

}  // namespace plica
