#include "mechanics/contact/self_contact.hpp"

#include <cstring>

#include "support/bodies.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"
#include "support/prisms.hpp"
#include "tissue/division.hpp"

namespace {

// A strip of cells, bent into a U whose inner, apical sides face each other across `gap_um`.
Tissue folded(double gap_um, int cells = 12) {
  const double inner = gap_um / 2, height = 10, arm = 60;
  const int arms = (cells - 4) / 2;
  return mapped_lattice(cells, 3, 1, [&](int i, int j, int k) {
    const double radius = inner + (k == 0 ? height : 0), y = 10.0 * j;
    if (i <= arms) return Vec3(-radius, y, arm - arm * i / arms);
    if (i >= cells - arms) return Vec3(radius, y, arm * (i - (cells - arms)) / arms);
    const double angle = M_PI * (i - arms) / 4;
    return Vec3(-radius * std::cos(angle), y, -radius * std::sin(angle));
  });
}

Motion with_pairs(const SelfContact& law, const Tissue& tissue) {
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  return motion;
}

TEST(SelfContact, PairsFaceEachOtherAndAreNoNeighbours) {
  const Tissue tissue = folded(3);
  const SelfContact law(tissue, {.search = 4});
  const auto pairs = law.pairs(tissue.rest_positions);
  ASSERT_FALSE(pairs.empty());
  for (const auto& pair : pairs) {
    const double gap = pair.gap(tissue.rest_positions);
    EXPECT_GT(gap, 0);
    EXPECT_LE(gap, 4);
    EXPECT_NEAR(pair.normal.norm(), 1, 1e-12);
    for (const SurfacePlace* place : {&pair.p, &pair.q})
      EXPECT_NEAR(std::accumulate(place->weights.begin(), place->weights.end(), 0.0), 1, 1e-12);
  }
  // A flat sheet has none, nor has one whose sides are farther apart than the search.
  EXPECT_TRUE(SelfContact(folded(30), {.search = 4}).pairs(folded(30).rest_positions).empty());
  const Tissue flat = build_block({.length_um = 60, .width_um = 60, .cell_height_um = 10, .cells = {6, 6, 1}});
  EXPECT_TRUE(SelfContact(flat, {.search = 40}).pairs(flat.rest_positions).empty());
}

// However nodes have moved since a law last looked, and however far: as a law sees it that looks for the first time.
TEST(SelfContact, PairsDoNotDependOnWhereNodesWereBefore) {
  const SelfContactRule rule{.search = 4};
  const Tissue tissue = folded(3);
  const SelfContact law(tissue, rule);
  Random random(3);
  Vectors positions = tissue.rest_positions;
  std::size_t pairs_in_all = 0;
  for (int motion = 0; motion < 60; ++motion) {
    // Small ones that add up, now and then a large one, and rigid ones of everything.
    const double size = motion % 10 == 9 ? 1.5 : 0.15;
    const Vec3 drift = motion % 3 == 0 ? Vec3(0.4, 0, -0.3) : Vec3(Vec3::Zero());
    const Vectors moves = random.vectors(positions.size());
    Vectors trial = positions;
    for (std::size_t n = 0; n < trial.size(); ++n) trial[n] += size * moves[n] + drift;
    const std::vector<SelfContact::Pair> found = law.pairs(trial), fresh = SelfContact(tissue, rule).pairs(trial);
    ASSERT_EQ(found.size(), fresh.size()) << "motion " << motion;
    EXPECT_EQ(std::memcmp(found.data(), fresh.data(), found.size() * sizeof(SelfContact::Pair)), 0)
        << "motion " << motion;
    pairs_in_all += found.size();
    if (size < 1) positions = trial;  // others are rejected steps
  }
  EXPECT_GT(pairs_in_all, 1000u);
}

// Where the surface creases sharply, places that lie on the edge of the facet beyond it touch that, and are no pair
// with it.
TEST(SelfContact, NodesThatHangOnAnEdgeAreNeighboursOfItsFacet) {
  const PrismSheet flat = irregular_polygons(9, 9, 7, 12, 0.2, 5);
  int hanging = 0, pairs_in_all = 0;
  for (double crease = -20; crease < 20; crease += 1.7) {
    const Tissue tissue = tissue_from_prisms(flat, PolygonSplit::diagonals, 1);
    Vectors positions = tissue.rest_positions;
    const double slope = 70 * M_PI / 180;
    for (Vec3& x : positions) {
      const double way = x.x() - crease;
      x = {way * std::cos(slope) - std::copysign(x.z() * std::sin(slope), way), x.y(), std::abs(way) * std::sin(slope)};
    }
    tissue.place_hanging_positions(positions);
    hanging += static_cast<int>(tissue.hanging.size());
    for (const auto& pair : SelfContact(tissue, {.search = 3}).pairs(positions)) {
      EXPECT_GT(pair.apart(positions).norm(), 1e-6);
      ++pairs_in_all;
    }
  }
  EXPECT_GT(hanging, 100);
  EXPECT_GT(pairs_in_all, 100);
}

TEST(SelfContact, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = folded(3);
  const SelfContact law(tissue, {.distance = 5, .stiffness = 0.2, .search = 6});
  Motion motion = with_pairs(law, tissue);
  Random random(4);
  for (Vec3& x : motion.positions) x += random.vector(0.5);
  expect_forces_are_minus_energy_gradient(law, motion, 1e-6);
  const Vectors direction = random.vectors(tissue.node_count());
  const Eigen::VectorXd product = product_of(law, motion.step(), direction);
  const auto forces_at = [&](double way) {
    Motion there = motion;
    for (std::size_t n = 0; n < direction.size(); ++n) there.positions[n] += way * direction[n];
    return flat(forces_of(law, there.step()));
  };
  const Eigen::VectorXd difference = -(forces_at(difference_um) - forces_at(-difference_um)) / (2 * difference_um);
  EXPECT_GT(difference.norm(), 1);
  EXPECT_LE((product - difference).norm(), 1e-6 * difference.norm());
  EXPECT_GE(flat(direction).dot(product), 0);
}

// Two parallel sides that overlap by less than `distance` push with stiffness times that, over the area that faces.
TEST(SelfContact, FlatOnFlatIsAPressure) {
  const Tissue tissue = folded(0.6, 20);
  const SelfContact law(tissue, {.distance = 0.4, .stiffness = 2, .search = 4});
  Motion motion = with_pairs(law, tissue);
  for (Vec3& x : motion.positions) x.x() -= x.x() > 0 ? 0.15 : -0.15;
  const Vectors forces = forces_of(law, motion.step());
  EXPECT_LE(resultant(forces).norm(), 1e-9);
  double push = 0;
  for (const Vec3& f : forces) push += std::abs(f.x()) / 2;
  // Points of both sides push, so the pressure is twice that of one.
  const double area = 60 * 30;
  EXPECT_NEAR(push / (2 * 2 * 0.1 * area), 1, 0.03);
}

// Whoever comes into view nearer than the distance (at rest, or round a corner) is not thrown back, but comes no
// nearer.
TEST(SelfContact, APairBeginsWithoutAForce) {
  const Tissue tissue = folded(0.3, 20);
  const SelfContact law(tissue, {.distance = 0.4, .stiffness = 2, .search = 4});
  Motion motion = with_pairs(law, tissue);
  EXPECT_FALSE(law.pairs(tissue.rest_positions).empty());
  EXPECT_LE(flat(forces_of(law, motion.step())).norm(), 1e-12);
  const auto squeeze = [&](double by) {
    for (Vec3& x : motion.positions) x.x() -= x.x() > 0 ? by : -by;
  };
  squeeze(0.02);
  EXPECT_GT(law.energy(motion.step()), 0);
  // As they part, the distance grows to that of the rule.
  squeeze(-0.05);
  motion.internal = law.next_internal(motion.step());
  squeeze(0.02);
  EXPECT_GT(law.energy(motion.step()), 0);
}

// Two sides of a thin ridge look away from each other, with tissue between them: each lies beyond the other, and is
// none of its business. Of the two sides of a groove that have been pushed through each other, each has gone through.
TEST(SelfContact, ARidgeIsNotAGroove) {
  const Tissue groove = folded(3);
  Tissue ridge = groove;  // inside out
  for (Facet& facet : ridge.apical_facets) std::ranges::reverse(facet.nodes);
  EXPECT_FALSE(SelfContact(groove, {.search = 4}).pairs(groove.rest_positions).empty());
  EXPECT_TRUE(SelfContact(ridge, {.search = 4}).pairs(ridge.rest_positions).empty());

  const SelfContact law(groove, {.search = 4});
  Motion motion = with_pairs(law, groove);
  for (Vec3& x : motion.positions) x.x() -= x.x() > 0 ? 1.6 : -1.6;
  const auto pairs = law.pairs(motion.positions, motion.internal);
  ASSERT_FALSE(pairs.empty());
  EXPECT_LT(pairs.front().first_gap, 0);
}

// The matrix is that of the product: what couples the two sides, too, of pairs that may touch in the step.
TEST(SelfContact, MatrixCouplesWhatMayTouch) {
  const Tissue tissue = folded(0.7);
  const SelfContact law(tissue, {.distance = 0.4, .search = 4});
  const Motion rest = with_pairs(law, tissue);
  const auto parted = [&](double by) {
    Motion there = rest;
    for (Vec3& x : there.positions) x.x() += x.x() > 0 ? by : -by;
    return there;
  };
  expect_assembled_is_matrix_free(law, parted(-0.2), 3);
  // Another pattern has another revision, the same pattern the same.
  const auto revision_after = [&](double by) { return law.groups_revision(law.next_internal(parted(by).step())); };
  EXPECT_EQ(revision_after(0), law.groups_revision(rest.internal));
  EXPECT_NE(revision_after(1), law.groups_revision(rest.internal));
}

// The push runs along the shortest way, however rough the surface: forces and moments add up to zero where a step
// begins, and sliding brings nothing nearer.
TEST(SelfContact, PushesAlongTheShortestWay) {
  const Tissue tissue = folded(3);
  const SelfContact law(tissue, {.distance = 2.5, .search = 6});
  Motion motion = with_pairs(law, tissue);
  Random random(8);
  for (Vec3& x : motion.positions) x += random.vector(0.6) - (x.x() > 0 ? 0.5 : -0.5) * Vec3::UnitX();
  motion.internal = law.next_internal(motion.step());
  const Vectors forces = forces_of(law, motion.step());
  EXPECT_GT(largest(forces), 10);
  EXPECT_LE(resultant(forces).norm(), 1e-9);
  EXPECT_LE(torque(forces, motion.positions).norm(), 1e-8);
  for (const auto& pair : SelfContact::pairs_of(motion.internal)) {
    const Vec3 apart = pair.apart(motion.positions);
    EXPECT_NEAR(std::abs(pair.normal.dot(apart)), apart.norm(), 1e-9);
  }
}

// What lies beside an open sheet is not over it, however near its rim may be.
TEST(SelfContact, BesideARimIsNotOverIt) {
  const auto pairs_at = [](double aside) {
    Bodies bodies;
    bodies.add({4, 4, 1}, [](int i, int j, int k) { return Vec3(10 * i, 10 * j, 10 * k); });
    bodies.add({4, 4, 1}, [&](int i, int j, int k) { return Vec3(10 * j, 10 * i + aside, 21 - 10 * k); });
    const Tissue tissue = bodies.tissue();
    return SelfContact(tissue, {.distance = 0.4, .search = 4}).pairs(tissue.rest_positions).size();
  };
  EXPECT_EQ(pairs_at(0), 162u);  // 25 nodes, 16 facets and 40 edges of either
  EXPECT_EQ(pairs_at(41), 0u);
  EXPECT_EQ(pairs_at(-41), 0u);
}

// Half of a U whose arm faces its own image: half of the energy, the same forces.
TEST(SelfContact, OneSideLeansOnItsImage) {
  const Tissue whole = folded(3);
  const auto [side, mirror] = side_of(whole, {true, false, false});
  const SelfContactRule rule{.distance = 5, .stiffness = 0.2, .search = 6};
  const SelfContact of_whole(whole, rule), of_side(whole, rule, mirror);
  Motion motion = with_pairs(of_side, side), whole_motion = with_pairs(of_whole, whole);
  const auto points = [](const Motion& there) {
    return std::ranges::count_if(SelfContact::pairs_of(there.internal),
                                 [](const ContactPair& pair) { return !pair.is_of_edges(); });
  };
  EXPECT_EQ(2 * points(motion), points(whole_motion));
  EXPECT_GT(points(motion), 10);
  for (Vec3& x : motion.positions) x.x() *= 0.8;
  whole_motion.positions = mirror.full_vectors(motion.positions);
  const double energy = of_side.energy(motion.step());
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(2 * energy, of_whole.energy(whole_motion.step()), 1e-9 * energy);
  const Vectors forces = forces_of(of_side, motion.step()), whole_forces = forces_of(of_whole, whole_motion.step());
  EXPECT_GT(largest(forces), 1);
  for (std::size_t n = 0; n < whole_forces.size(); ++n) {
    if (side.rest_positions[mirror.nodes[n].node.index()].x() == 0) continue;
    EXPECT_LT((MirroredVectors{mirror, forces}[n] - whole_forces[n]).norm(), 1e-9) << n;
  }

  Random random(4);
  for (Vec3& x : motion.positions) x += random.vector(0.3);
  expect_forces_are_minus_energy_gradient(of_side, motion, 1e-6);
  expect_tangent_is_minus_force_gradient(of_side, motion, 1e-6);
  expect_assembled_is_matrix_free(of_side, motion, 5);
  const NodeGroups groups = of_side.node_groups(motion.internal);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const NodeId node : groups[g]) EXPECT_LT(node.index(), side.node_count());
}

// The same with edges that cross: half of a U whose arms are rough.
TEST(SelfContact, EdgesLeanOnTheirImages) {
  const Tissue whole = folded(3);
  const auto [side, mirror] = side_of(whole, {true, false, false});
  const SelfContactRule rule{.distance = 4, .stiffness = 0.2, .search = 6};
  const SelfContact of_whole(whole, rule), of_side(whole, rule, mirror);
  Motion motion = with_pairs(of_side, side), whole_motion = with_pairs(of_whole, whole);
  Random random(4);
  for (Vec3& x : motion.positions) {
    const Vec3 moved = x + random.vector(1);
    x = {x.x() == 0 ? 0 : moved.x(), moved.y(), moved.z()};
  }
  whole_motion.positions = mirror.full_vectors(motion.positions);
  motion.internal = of_side.next_internal(motion.step());
  whole_motion.internal = of_whole.next_internal(whole_motion.step());
  for (Vec3& x : motion.positions) x.x() *= 0.7;
  whole_motion.positions = mirror.full_vectors(motion.positions);
  const auto pressed = [](const Motion& there, const auto& positions) {
    return std::ranges::count_if(SelfContact::pairs_of(there.internal), [&](const ContactPair& pair) {
      return pair.is_of_edges() && pair.gap(positions) < pair.distance;
    });
  };
  EXPECT_GT(pressed(whole_motion, whole_motion.positions), 20);
  EXPECT_GT(pressed(motion, MirroredVectors{mirror, motion.positions}), 10);
  const double energy = of_side.energy(motion.step());
  EXPECT_NEAR(2 * energy, of_whole.energy(whole_motion.step()), 1e-9 * energy);
  const Vectors forces = forces_of(of_side, motion.step()), whole_forces = forces_of(of_whole, whole_motion.step());
  for (std::size_t n = 0; n < whole_forces.size(); ++n) {
    if (side.rest_positions[mirror.nodes[n].node.index()].x() == 0) continue;
    EXPECT_LT((MirroredVectors{mirror, forces}[n] - whole_forces[n]).norm(), 1e-9) << n;
  }
  expect_forces_are_minus_energy_gradient(of_side, motion, 1e-6);
  expect_assembled_is_matrix_free(of_side, motion, 5);
}

// A ridge along x between two apical faces, in the y-z plane from a over the tip to b, clockwise about the tissue,
// which reaches towards `inside`.
void add_ridge(Bodies& bodies, const std::array<Vec3, 3>& way, const Vec3& inside) {
  bodies.add({1, 2, 1}, [=](int i, int j, int k) -> Vec3 {
    const Vec3& place = way[j];
    return Vec3(10.0 * i, 0, 0) + (k == 1 ? place : Vec3(place + 0.4 * (inside - place)));
  });
}

// The pairs of points that are nodes at a place.
std::vector<ContactPair> pairs_at(const Vec3& place, const std::vector<ContactPair>& pairs, const Tissue& tissue) {
  std::vector<ContactPair> result;
  for (const ContactPair& pair : pairs)
    if (!pair.is_of_edges() && pair.p.count() == 1 && (pair.p.at(tissue.rest_positions) - place).norm() < 1e-9)
      result.push_back(pair);
  return result;
}

// Lips that lean on each other with their last edges: however wide the faces are that lead away from them.
TEST(SelfContact, TipsSeeEachOther) {
  for (const double width : {5, 16, 40}) {
    Bodies bodies;
    const Vec3 left(0, -0.1, 0), right(0, 0.1, 0);
    add_ridge(bodies, {Vec3(0, -0.1, 16), left, Vec3(0, -width, 0)}, {0, -10, 10});
    add_ridge(bodies, {Vec3(0, width, 0), right, Vec3(0, 0.1, 16)}, {0, 10, 10});
    const Tissue tissue = bodies.tissue();
    const auto pairs = SelfContact(tissue, {.distance = 0.4, .search = 4}).pairs(tissue.rest_positions);
    for (const auto& [tip, way] : {std::pair(left, -1.0), std::pair(right, 1.0)}) {
      const auto of_tip = pairs_at(tip, pairs, tissue);
      ASSERT_EQ(of_tip.size(), 1u) << width;
      EXPECT_NEAR(of_tip[0].normal.y(), way, 1e-12);
      EXPECT_NEAR(of_tip[0].first_gap, 0.2, 1e-12);
    }
  }
}

// Where three ridges meet, each tip leans on both others.
TEST(SelfContact, ATipLeansOnTwo) {
  Bodies bodies;
  const std::array tips = {Vec3(0, -0.2, 0), Vec3(0, 0.2, 0), Vec3(0, 0, 0.3)};
  add_ridge(bodies, {Vec3(0, -10, 10), tips[0], Vec3(0, -10, -6)}, {0, -20, 0});
  add_ridge(bodies, {Vec3(0, 10, -6), tips[1], Vec3(0, 10, 10)}, {0, 20, 0});
  add_ridge(bodies, {Vec3(0, 10, 10.6), tips[2], Vec3(0, -10, 10.6)}, {0, 0, 20});
  const Tissue tissue = bodies.tissue();
  const SelfContact law(tissue, {.distance = 0.4, .search = 4});
  const auto pairs = law.pairs(tissue.rest_positions);
  for (const Vec3& tip : tips) {
    const auto of_tip = pairs_at(tip, pairs, tissue);
    ASSERT_EQ(of_tip.size(), 2u);
    EXPECT_LE(of_tip[0].first_gap, of_tip[1].first_gap + 1e-12);
    EXPECT_GT(of_tip[0].first_gap, 0);
  }
  // Each remembers its own, not the other's.
  Motion motion = with_pairs(law, tissue);
  EXPECT_EQ(law.next_internal(motion.step()), motion.internal);
}

// A point that has gone through is pushed back out.
TEST(SelfContact, GapsHaveASign) {
  const Tissue tissue = folded(3);
  const SelfContact law(tissue, {.distance = 0.4, .search = 6});
  Motion motion = with_pairs(law, tissue);
  EXPECT_EQ(law.energy(motion.step()), 0);
  for (Vec3& x : motion.positions) x.x() -= 2.5 * (x.x() > 0 ? 1 : -1);
  EXPECT_GT(law.energy(motion.step()), 0);
  const Vectors forces = forces_of(law, motion.step());
  int pushed = 0;
  for (std::size_t n = 0; n < forces.size(); ++n) {
    if (std::abs(forces[n].x()) <= 1e-9 || tissue.rest_positions[n].z() <= 10) continue;
    EXPECT_GT(forces[n].x() * tissue.rest_positions[n].x(), 0) << "node " << n;
    ++pushed;
  }
  EXPECT_GT(pushed, 0);
}

// Sides that have been pushed through each other push back as before, though points and facets are others.
TEST(SelfContact, LivesOnThroughADivision) {
  Tissue tissue = folded(0.6, 20);
  const SelfContact law(tissue, {.distance = 0.4, .stiffness = 2, .search = 4});
  Motion motion = with_pairs(law, tissue);
  for (Vec3& x : motion.positions) x.x() -= x.x() > 0 ? 0.35 : -0.35;
  motion.internal = law.next_internal(motion.step());
  const auto push = [](const Law& one, const Motion& there) {
    double sum = 0;
    for (const Vec3& f : forces_of(one, there.step())) sum += std::abs(f.x()) / 2;
    return sum;
  };
  const double before = push(law, motion);
  EXPECT_GT(before, 0);
  std::vector<CellCut> cuts;
  for (int c = 0; c < 60; c += 3) cuts.push_back({CellId(c), c % 2});
  const TissueChange change = divide(tissue, cuts, 0, motion.positions);
  const Vectors now = with_new_nodes(tissue, change, motion.positions);
  Motion after = at_rest(tissue);
  after.positions = after.previous_positions = now;
  after.internal = law.internal_after_change(motion.internal, tissue, change, {motion.positions, now});
  EXPECT_NEAR(push(*law.after_change(tissue, change, now), after) / before, 1, 0.03);
  after.internal = law.internal_after_change(motion.internal, tissue, change, {});
  EXPECT_TRUE(SelfContact::pairs_of(after.internal).empty());
}

}  // namespace
