// Contact of edges, and the closest points of facets and edges.
#include "mechanics/contact/edge_pairs.hpp"

#include "measure/self_intersections.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/roofs.hpp"

namespace {

// The upper one, with the pairs of where it was at rest.
Motion moved_down(const Tissue& tissue, const SelfContact& law, std::size_t upper, double by) {
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  for (std::size_t n = upper; n < tissue.node_count(); ++n) motion.positions[n].z() -= by;
  return motion;
}

constexpr SelfContactRule rule{.distance = 0.4, .stiffness = 2, .search = 6};

TEST(EdgePairs, TwoRidgesAreASpring) {
  const Roofs roofs(1);
  const Tissue tissue = roofs.bodies.tissue();
  const SelfContact law(tissue, rule);
  const auto at = [&](double gap) { return moved_down(tissue, law, roofs.upper, 1 - gap); };
  const std::vector<ContactPair> pairs = edges_of(at(1).internal);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_NEAR(pairs[0].first_gap, 1, 1e-12);
  EXPECT_NEAR(std::abs(pairs[0].normal.z()), 1, 1e-12);
  EXPECT_NEAR(pairs[0].distance, rule.distance / 2, 1e-12);
  // A third of a quarter of each of the two sides.
  const double area = EdgePairs::stiffening * 2 * Roofs::ridge * Roofs::slope * std::sqrt(2) / 12;
  EXPECT_NEAR(pairs[0].area, area, 1e-9);
  EXPECT_EQ(law.energy(at(0.21).step()), 0);
  for (const double gap : {0.15, 0.0, -0.1}) {
    const double inside = rule.distance / 2 - gap, push = rule.stiffness * area * inside;
    EXPECT_NEAR(law.energy(at(gap).step()), push * inside / 2, 1e-9);
    const Vectors forces = forces_of(law, at(gap).step());
    EXPECT_LT((sum_from(forces, roofs.upper) - Vec3(0, 0, push)).norm(), 1e-9);
    EXPECT_LT(resultant(forces).norm(), 1e-9);
    // The crossing is at 5/8 of the way along either ridge, and the two share the push so.
    for (std::size_t n = 0; n < roofs.upper; ++n) {
      const Vec3& x = tissue.rest_positions[n];
      const bool is_end = x.z() == 0;
      EXPECT_NEAR(forces[n].z(), is_end ? -push * (x.x() > 0 ? 0.625 : 0.375) : 0, 1e-9);
    }
  }
  // None where it is farther than four distances.
  EXPECT_TRUE(
      edges_of(SelfContact(Roofs(1.7).bodies.tissue(), rule).first_internal(Roofs(1.7).bodies.tissue())).empty());
}

TEST(EdgePairs, DerivativesAgreeWithFiniteDifferences) {
  const Roofs roofs(0.3);
  const Tissue tissue = roofs.bodies.tissue();
  SelfContactRule rough = rule;
  for (const double friction : {0.0, 0.5}) {
    rough.friction = friction;
    const SelfContact law(tissue, rough);
    Motion motion = moved_down(tissue, law, roofs.upper, 0.2);
    motion.previous_positions = motion.positions;
    motion.internal = law.next_internal(motion.step());
    ASSERT_EQ(edges_of(motion.internal).size(), 1u);
    Random random(7);
    for (Vec3& x : motion.positions) x += random.vector(0.03);
    ASSERT_GT(law.energy(motion.step()), 0.01);
    const Vectors direction = random.vectors(tissue.node_count());
    const double d = 1e-6;
    const auto there = [&](double way) {
      Motion moved = motion;
      for (std::size_t n = 0; n < direction.size(); ++n) moved.positions[n] += way * direction[n];
      return moved;
    };
    const Eigen::VectorXd forces = flat(forces_of(law, motion.step()));
    EXPECT_NEAR((law.energy(there(d).step()) - law.energy(there(-d).step())) / (2 * d), -forces.dot(flat(direction)),
                1e-6 * forces.norm());
    const Eigen::VectorXd product = product_of(law, motion.step(), direction);
    const Eigen::VectorXd difference =
        -(flat(forces_of(law, there(d).step())) - flat(forces_of(law, there(-d).step()))) / (2 * d);
    EXPECT_GT(difference.norm(), 0.1);
    EXPECT_LE((product - difference).norm(), 1e-4 * difference.norm());
    expect_assembled_is_matrix_free(law, motion, 3);
    EXPECT_LE(resultant(forces_of(law, motion.step())).norm(), 1e-9);
  }
}

// A pair that has gone through knows it, and is pushed back; one that was never seen apart is not.
TEST(EdgePairs, RememberTheirSide) {
  const Roofs roofs(0.5);
  const Tissue tissue = roofs.bodies.tissue();
  const SelfContact law(tissue, rule);
  Motion motion = moved_down(tissue, law, roofs.upper, 0.4);
  double push = 0;
  for (const double by : {0.0, 0.15, 0.1, 0.1}) {  // to a gap of 0.1, then -0.05, -0.15 and -0.25
    for (std::size_t n = roofs.upper; n < tissue.node_count(); ++n) motion.positions[n].z() -= by;
    motion.internal = law.next_internal(motion.step());
    ASSERT_EQ(edges_of(motion.internal).size(), 1u) << by;
    const double now = sum_from(forces_of(law, motion.step()), roofs.upper).z();
    EXPECT_GT(now, push);
    push = now;
  }
  EXPECT_NEAR(edges_of(motion.internal)[0].first_gap, -0.25, 1e-12);
  EXPECT_EQ(motion.internal.size(), law.next_internal(motion.step()).size());
  const Tissue through = Roofs(-0.25).bodies.tissue();
  EXPECT_TRUE(edges_of(SelfContact(through, rule).first_internal(through)).empty());
}

// A ridge that slides from one edge of the other onto the next pushes as before; where none was seen, a pair begins
// without a force.
TEST(EdgePairs, SlideFromEdgeToEdge) {
  const Roofs roofs(0.5, 2);
  const Tissue tissue = roofs.bodies.tissue();
  const SelfContact law(tissue, rule);
  Motion motion = moved_down(tissue, law, roofs.upper, 0.4);
  motion.internal = law.next_internal(motion.step());
  const auto push = [&] { return sum_from(forces_of(law, motion.step()), roofs.upper).z(); };
  const double before = push();
  const ContactPair first = edges_of(motion.internal).at(0);
  EXPECT_NEAR(before, rule.stiffness * first.area * 0.1, 1e-9);
  for (std::size_t n = roofs.upper; n < tissue.node_count(); ++n) motion.positions[n].x() -= Roofs::aside + 5;
  motion.internal = law.next_internal(motion.step());
  const std::vector<ContactPair> now = edges_of(motion.internal);
  ASSERT_EQ(now.size(), 1u);
  EXPECT_FALSE(now[0].first == first.first && now[0].second == first.second);
  EXPECT_NEAR(now[0].distance, rule.distance / 2, 1e-12);
  EXPECT_NEAR(push(), before, 1e-9);

  const Tissue near = Roofs(0.1, 2).bodies.tissue();
  const std::vector<ContactPair> at_rest = edges_of(SelfContact(near, rule).first_internal(near));
  ASSERT_EQ(at_rest.size(), 1u);
  EXPECT_NEAR(at_rest[0].distance, 0.1, 1e-12);
}

// Pressed together until the crossing has given way by several distances: with edges the roofs bend, without they pass
// through each other, and no point notices.
TEST(EdgePairs, RidgesDoNotPassThroughEachOther) {
  for (const bool with_edges : {false, true}) {
    const Roofs roofs(0.5);
    SelfContactRule pressed = rule;
    pressed.with_edges = with_edges;
    Model model = model_of(roofs, pressed);
    const Tissue& tissue = model.tissue;
    for (std::size_t n = roofs.upper; n < tissue.node_count(); ++n)
      if (tissue.rest_positions[n].z() > Roofs::height) model.held[n] = {true, true, true};
    NewtonStepper stepper(model);
    State state = rest_state(model), next;
    std::size_t crossed = 0, pressed_steps = 0;
    for (int step = 0; step < 20; ++step) {
      for (std::size_t n = roofs.upper; n < tissue.node_count(); ++n)
        if (model.held[n][0]) state.positions[n].z() -= 0.1;
      const StepReport report = stepper.advance(state, 5, true, next);
      ASSERT_TRUE(report.converged()) << report.reason();
      std::swap(state, next);
      crossed += self_intersections(tissue, state.positions);
      for (const ContactPair& pair : SelfContact::pairs_of(state.internals.back())) {
        if (pair.first_gap >= pair.distance) continue;
        EXPECT_TRUE(pair.is_of_edges()) << "a point touches";
        ++pressed_steps;
      }
    }
    std::printf("%s edges: %zu crossings in 20 steps, edges press in %zu\n", with_edges ? "with" : "without", crossed,
                pressed_steps);
    EXPECT_EQ(crossed == 0, with_edges);
    EXPECT_EQ(pressed_steps > 10, with_edges);
  }
}

using Stretch = std::pair<Vec3, Vec3>;

double distance_to(const Vec3& p, const Stretch& stretch) {
  const Vec3 way = stretch.second - stretch.first;
  const double squared = way.squaredNorm();
  const double part = squared > 0 ? std::clamp(way.dot(p - stretch.first) / squared, 0.0, 1.0) : 0;
  return (p - stretch.first - part * way).norm();
}

Vec3 at(const Stretch& stretch, double part) { return stretch.first + part * (stretch.second - stretch.first); }

// The distance of a place on the first from the second is convex along it.
double distance_by_search(const Stretch& first, const Stretch& second) {
  double low = 0, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (distance_to(at(first, a), second) < distance_to(at(first, b), second) ? high : low) =
        distance_to(at(first, a), second) < distance_to(at(first, b), second) ? b : a;
  }
  return distance_to(at(first, (low + high) / 2), second);
}

double distance_of_ends(const Stretch& first, const Stretch& second) {
  return std::min({distance_to(first.first, second), distance_to(first.second, second),
                   distance_to(second.first, first), distance_to(second.second, first)});
}

TEST(NearestInside, IsTheNearestOrAnEndIs) {
  Random random(3);
  const char* const kinds[] = {"any", "parallel", "on one line", "no length", "two without length", "nearly parallel"};
  for (int kind = 0; kind < 6; ++kind) {
    int inside = 0;
    constexpr int cases = 2000;
    for (int k = 0; k < cases; ++k) {
      Stretch first{random.vector(), random.vector()}, second{random.vector(), random.vector()};
      const Vec3 way = first.second - first.first;
      if (kind == 1) second.second = second.first + random.number() * way;
      if (kind == 2) second = {at(first, random.number(2)), at(first, random.number(2))};
      if (kind == 3) second.second = second.first;
      if (kind == 4) first.second = first.first, second.second = second.first;
      if (kind == 5) {  // crossing, at a small angle
        const Vec3 middle = at(first, 0.5) + 0.1 * random.vector(), turned = way + 0.01 * random.vector();
        second = {middle - turned / 2, middle + turned / 2};
      }
      const double truth = distance_by_search(first, second);
      if (const auto places = nearest_inside(first.first, first.second, second.first, second.second)) {
        ++inside;
        EXPECT_GT(places->on_first, 0);
        EXPECT_LT(places->on_first, 1);
        EXPECT_GT(places->on_second, 0);
        EXPECT_LT(places->on_second, 1);
        const Vec3 apart = at(first, places->on_first) - at(second, places->on_second);
        EXPECT_NEAR(apart.norm(), truth, 1e-7) << kinds[kind];
        EXPECT_NEAR(apart.dot(way), 0, 1e-9) << kinds[kind];
        EXPECT_NEAR(apart.dot(second.second - second.first), 0, 1e-9) << kinds[kind];
      } else {
        EXPECT_NEAR(distance_of_ends(first, second), truth, kind == 5 ? 1e-3 : 1e-7) << kinds[kind];
      }
    }
    std::printf("%-18s %d cases, %d inside\n", kinds[kind], cases, inside);
    EXPECT_EQ(inside > 0, kind == 0 || kind == 5) << kinds[kind];
  }
}

}  // namespace
