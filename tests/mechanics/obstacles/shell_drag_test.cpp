#include "mechanics/obstacles/shell_drag.hpp"

#include "support/law_checks.hpp"

namespace {

// The apical face of a block, 100 um from the axis, and a shell this far from it.
Tissue block() {
  Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 10, .cells = {4, 2, 1}});
  Vectors positions = tissue.rest_positions;
  double top = 0;
  for (const Facet& facet : tissue.apical_facets) top = positions[facet.nodes[0].index()].z();
  for (Vec3& x : positions) {
    const double radius = 100 + x.z() - top, angle = x.y() / 100;
    x = {x.x(), radius * std::sin(angle), radius * std::cos(angle)};
  }
  return with_rest_positions(std::move(tissue), std::move(positions));
}

ShellDrag drag_at(const Tissue& tissue, double gap) { return {tissue, Capsule{50, 100 + gap}, 0.3}; }

TEST(ShellDrag, DerivativesAgreeWithFiniteDifferences) {
  check_derivatives(drag_at(block(), 60), block(), 1);  // nodes move about: some are inside, some outside
  check_semidefinite_tangent(drag_at(block(), 60), block(), 1, false);
}

TEST(ShellDrag, SlowsWhatSlidesAlongTheShellAndTouchesIt) {
  const Tissue tissue = block();
  double area = 0;
  for (const Facet& facet : tissue.apical_facets) area += facet_area(rest_corners(tissue, facet));
  const auto slid = [&](double gap, const Vec3& by) {
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x += by;
    return forces_of(drag_at(tissue, gap), motion.step());
  };
  // All of it on the shell, half at half of the film, none beyond.
  for (const auto& [gap, part] : {std::pair(0.0, 1.0), {0.05, 0.5}, {0.11, 0.0}, {-0.01, 1.0}}) {
    const Vec3 force = resultant(slid(gap, {0.7, 0, 0}));  // in 0.7 s
    EXPECT_NEAR(force.x(), -part * 0.3 * area, 1e-9 * area);
    EXPECT_NEAR(force.tail<2>().norm(), 0, 1e-9);
  }
  // Only of apical nodes, and none against leaving.
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3 radial = Vec3(0, tissue.rest_positions[n].y(), tissue.rest_positions[n].z()).normalized();
    Motion motion = at_rest(tissue);
    motion.positions[n] -= 3 * radial;
    EXPECT_LE(largest(forces_of(drag_at(tissue, 0), motion.step())), 1e-9);
  }
}

}  // namespace
