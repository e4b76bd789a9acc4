// Contact forces as functions of where their pairs were found.
#include "mechanics/derivatives.hpp"
#include "support/law_checks.hpp"
#include "support/roofs.hpp"

namespace {

// Forces at fixed positions, as functions of the positions `found_at` at which pairs were found by a step from rest,
// and at which the step of the forces begins.
void expect_derivatives_by_pairs(const Tissue& tissue, const SelfContact& law, const Vectors& found_at,
                                 const Vectors& positions, unsigned seed) {
  Random random(seed);
  const Vectors adjoint = random.vectors(tissue.node_count()), direction = random.vectors(tissue.node_count());
  Motion finding = at_rest(tissue);
  finding.internal = law.first_internal(tissue);
  const auto pairs_at = [&](double way) {
    finding.positions = found_at;
    for (std::size_t n = 0; n < found_at.size(); ++n) finding.positions[n] += way * direction[n];
    return law.next_internal(finding.step());
  };
  Motion motion = at_rest(tissue);
  motion.positions = positions;
  motion.earlier_positions = tissue.rest_positions;
  motion.ahead = 0.3;
  const auto along_adjoint = [&](double way) {
    motion.internal = pairs_at(way);
    motion.previous_positions = finding.positions;
    return flat(adjoint).dot(flat(forces_of(law, motion.step())));
  };
  const double d = 2e-6, difference = (along_adjoint(d) - along_adjoint(-d)) / (2 * d);

  motion.internal = pairs_at(0);
  motion.previous_positions = finding.positions;
  Vectors none(tissue.node_count(), Vec3::Zero()), by_positions = none;
  std::vector<double> by_pairs(motion.internal.size(), 0.0), by_before(finding.internal.size(), 0.0);
  const LawDerivatives& derivatives = law.derivatives();
  derivatives.add_force_gradient(motion.step(), adjoint, {motion.ahead, by_positions, none, by_pairs});
  derivatives.add_internal_gradient(finding.step(), motion.internal, by_pairs, by_positions,
                                    {0, none, none, by_before});
  ASSERT_GT(std::abs(difference), 0.1);
  EXPECT_NEAR(flat(by_positions).dot(flat(direction)), difference, 1e-6 * std::abs(difference));
}

TEST(ContactDerivatives, FollowPointsAndEdges) {
  for (const double gap : {0.35, 0.15}) {  // the second starts below the contact distance
    const Roofs roofs(gap + 0.1);
    const Tissue tissue = roofs.bodies.tissue();
    for (const double friction : {0.0, 0.5}) {
      const SelfContact law(tissue, {.distance = 0.4, .stiffness = 2, .search = 6, .friction = friction});
      Vectors found_at = tissue.rest_positions;
      for (std::size_t n = roofs.upper; n < found_at.size(); ++n) found_at[n].z() -= 0.1;
      Random random(5);
      for (Vec3& x : found_at) x += random.vector(0.02);
      Vectors positions = found_at;
      for (std::size_t n = roofs.upper; n < found_at.size(); ++n) positions[n].z() -= 0.3;
      expect_derivatives_by_pairs(tissue, law, found_at, positions, 3);
    }
  }
}

TEST(ContactDerivatives, FollowPointsOnFacets) {
  // Two layers of cells that face each other across 0.5 um, one shifted along.
  Bodies bodies;
  bodies.add({3, 3, 1}, [](int i, int j, int k) { return Vec3(10.0 * i, 10.0 * j, 10.0 * k); });
  const std::size_t upper =
      bodies.add({3, 3, 1}, [](int i, int j, int k) { return Vec3(10.0 * j + 2, 10.0 * i + 3, 20.5 - 10.0 * k); });
  const Tissue tissue = bodies.tissue();
  Vectors found_at = tissue.rest_positions;
  Random random(6);
  for (Vec3& x : found_at) x += random.vector(0.2);
  Vectors positions = found_at;
  for (std::size_t n = upper; n < found_at.size(); ++n) positions[n].z() -= 0.4;
  for (const double friction : {0.0, 0.5})
    expect_derivatives_by_pairs(
        tissue, SelfContact(tissue, {.distance = 0.4, .stiffness = 2, .search = 6, .friction = friction}), found_at,
        positions, 4);
}

}  // namespace
