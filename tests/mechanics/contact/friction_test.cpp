// Friction between surfaces of one tissue: Coulomb's, by the pressure at the beginning of the step.
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/coulomb.hpp"
#include "mechanics/energy.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/bodies.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"

namespace {

constexpr double coefficient = 0.5;

// A block of 3 x 3 cells on a larger, fixed one; what they have between them is pressed by 0.1 um.
struct OnTable {
  Bodies bodies;
  std::size_t upper;

  OnTable() {
    bodies.add({9, 9, 1}, [](int i, int j, int k) { return Vec3(10. * i - 45, 10. * j - 45, 10. * k - 10); });
    upper = bodies.add({3, 3, 1},
                       [](int i, int j, int k) { return Vec3(9. * j - 13.5, 9. * i - 13.5, 0.5 + 8 * (1 - k)); });
  }
};

SelfContact rough(const Tissue& tissue) {
  return {tissue, {.distance = 0.4, .stiffness = 2, .search = 4, .friction = coefficient}};
}

// At the beginning of a step that slides by so much.
Motion pressed(const OnTable& table, const SelfContact& law, const Tissue& tissue) {
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  for (std::size_t n = table.upper; n < tissue.node_count(); ++n) motion.positions[n].z() -= 0.2;
  motion.internal = law.next_internal(motion.step());
  motion.previous_positions = motion.positions;
  return motion;
}

TEST(Friction, DerivativesAgreeWithFiniteDifferences) {
  const OnTable table;
  const Tissue tissue = table.bodies.tissue();
  const SelfContact law = rough(tissue);
  Random random(5);
  for (const double size : {1e-3, 0.05}) {  // sticking and sliding, where a step has 0.7 s
    Motion motion = pressed(table, law, tissue);
    motion.earlier_positions = motion.previous_positions;
    motion.ahead = 0.4;
    for (std::size_t n = 0; n < tissue.node_count(); ++n) {
      motion.earlier_positions[n] += random.vector(size);
      motion.positions[n] += random.vector(size);
    }
    const Vectors direction = random.vectors(tissue.node_count());
    const double d = 1e-6;
    const auto there = [&](double way) {
      Motion moved = motion;
      for (std::size_t n = 0; n < direction.size(); ++n) moved.positions[n] += way * direction[n];
      return moved;
    };
    const Eigen::VectorXd forces = flat(forces_of(law, motion.step()));
    EXPECT_NEAR((law.energy(there(d).step()) - law.energy(there(-d).step())) / (2 * d), -forces.dot(flat(direction)),
                1e-5 * forces.norm());
    const Eigen::VectorXd product = product_of(law, motion.step(), direction);
    const Eigen::VectorXd difference =
        -(flat(forces_of(law, there(d).step())) - flat(forces_of(law, there(-d).step()))) / (2 * d);
    EXPECT_LE((product - difference).norm(), 1e-3 * difference.norm());
    EXPECT_GE(flat(direction).dot(product), 0);
    expect_assembled_is_matrix_free(law, motion, 3);
    EXPECT_LE(resultant(forces_of(law, motion.step())).norm(), 1e-9);
  }
}

// Whatever the motion, friction takes power, and is no more than its part of the pressing force.
TEST(Friction, TakesPower) {
  const OnTable table;
  const Tissue tissue = table.bodies.tissue();
  const SelfContact law = rough(tissue), smooth(tissue, {.distance = 0.4, .stiffness = 2, .search = 4});
  Random random(6);
  for (int k = 0; k < 20; ++k) {
    Motion motion = pressed(table, law, tissue);
    for (Vec3& x : motion.positions) x += random.vector(std::pow(10, random.number(3) - 2));
    const Vectors all = forces_of(law, motion.step()), normal = forces_of(smooth, motion.step());
    double power = 0;
    for (std::size_t n = 0; n < all.size(); ++n)
      power += (all[n] - normal[n]).dot(motion.positions[n] - motion.previous_positions[n]);
    EXPECT_LT(power, 0);
  }
  // All of it where the block slides as a whole.
  Motion motion = pressed(table, law, tissue);
  const Vec3 push = sum_from(forces_of(law, motion.step()), table.upper);
  for (std::size_t n = table.upper; n < tissue.node_count(); ++n) motion.positions[n].y() += 0.1;
  const Vec3 sliding = sum_from(forces_of(law, motion.step()), table.upper);
  EXPECT_GT(push.z(), 10);
  EXPECT_NEAR(sliding.z(), push.z(), 1e-9);
  EXPECT_NEAR(sliding.y(), -coefficient * push.z(), 1e-9);

  // Force times way is lost.
  Model model(tissue);
  model.laws.push_back(law.clone());
  model.laws.push_back(smooth.clone());
  State before = rest_state(model), after;
  before.positions = motion.previous_positions;
  before.internals = {motion.internal, motion.internal};
  after = before;
  after.positions = motion.positions;
  after.time_s = 1;
  after.internals = {law.next_internal(motion.step()), smooth.next_internal(motion.step())};
  const std::vector<EnergyFlow> flows = energy_flows(model, before, after);
  EXPECT_NEAR(flows[0].dissipated - flows[1].dissipated, coefficient * push.z() * 0.1, 1e-9);
}

// A block is pressed down and pushed along: below the coefficient it creeps as slowly as the law says, above it slides
// as fast as what friction leaves drives it through its drag.
TEST(Friction, ABlockSticksBelowTheCoefficientAndSlidesAboveIt) {
  constexpr double down = 200, drag = 0.02;  // nN, nN s/um^3
  const OnTable table;
  const auto middle = [&](const State& state) {
    const std::size_t nodes = state.positions.size() - table.upper;
    return sum_from(state.positions, table.upper).x() / static_cast<double>(nodes);
  };
  for (const double ratio : {0.2, 0.45, 0.55, 1.0}) {
    Model model(table.bodies.tissue());
    const Tissue& tissue = model.tissue;
    model.volumes.hold(false);
    const ElasticModuli stiff = ElasticModuli::from_young(100, 0);  // what is soft goes on creeping for long
    model.laws.push_back(std::make_unique<Corotational>(tissue, in_elements(tissue, stiff), 0));
    model.laws.push_back(std::make_unique<Dilatation>(tissue, in_elements(tissue, stiff.bulk_modulus()), false));
    add_drag(model, drag);
    model.laws.push_back(std::make_unique<SelfContact>(rough(tissue)));
    Vectors loads(tissue.node_count(), Vec3::Zero());
    // Along the face below, so that nothing tilts.
    double area = 0;
    for (const auto& [facets, force] :
         {std::pair(&tissue.basal_facets, Vec3(0, 0, -down)), {&tissue.apical_facets, Vec3(ratio * down, 0, 0)}})
      for (const Facet& facet : *facets) {
        if (facet.nodes[0].index() < table.upper) continue;
        for (const NodeId node : facet.nodes) loads[node.index()] += force / 36;
        area += facet_area(rest_corners(tissue, facet));
      }
    model.laws.push_back(std::make_unique<NodalForces>(loads));
    for (std::size_t n = 0; n < table.upper; ++n) model.held[n] = {true, true, true};
    NewtonStepper stepper(model);
    State state = rest_state(model), next;
    double before = 0;
    double step_s = 0.01;
    for (int step = 0; step < 60; ++step) {
      if (step > 0) step_s = std::min(1.5 * step_s, ratio > coefficient ? 0.05 : 5);
      before = middle(state);
      const StepReport report = stepper.advance(state, step_s, true, next);
      ASSERT_TRUE(report.converged()) << report.reason();
      std::swap(state, next);
    }
    const double speed = (middle(state) - before) / step_s;
    const double sliding = (ratio - coefficient) * down / (drag * area);
    // The drag of what creeps is a ten-thousandth of the force.
    const double creeping = Coulomb::stick_speed * (1 - std::sqrt(1 - std::min(1.0, ratio / coefficient)));
    const double expected = ratio > coefficient ? sliding : creeping;
    std::printf("pushed by %.2f of the pressing force: %.5f um/s, expected %.5f\n", ratio, speed, expected);
    EXPECT_NEAR(speed / expected, 1, 0.01);
  }
}

}  // namespace
