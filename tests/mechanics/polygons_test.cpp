// Laws on cells that are polygons, and on tissues with periods.
#include "mechanics/active/contraction.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/active/shape_activation.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "mechanics/elasticity/corner_barrier.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/shape_memory.hpp"
#include "mechanics/surroundings.hpp"
#include "support/constraint_law.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/prisms.hpp"
#include "tissue/faces.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace {

class LawsOnPolygons : public testing::TestWithParam<PolygonSplit> {
 protected:
  const Tissue tissue =
      tissue_from_prisms(bent(irregular_polygons(4, 4, 8, 20, 0.1, 3),
                              [](const Vec3& x) {
                                const double radius = 80 + x.z(), angle = x.x() / 80;
                                return Vec3(radius * std::sin(angle), x.y(), radius * std::cos(angle));
                              }),
                         GetParam(), 1);
  const CellSet all = CellSet(tissue.cells.size(), true);
};

INSTANTIATE_TEST_SUITE_P(Splits, LawsOnPolygons, testing::Values(PolygonSplit::diagonals, PolygonSplit::kites),
                         [](const auto& given) { return given.param == PolygonSplit::kites ? "kites" : "diagonals"; });

TEST_P(LawsOnPolygons, DerivativesAgreeWithFiniteDifferences) {
  const double size_um = 0.3;
  check_derivatives(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(1, 0.45)), 2), tissue, size_um,
                    1);
  check_derivatives(NeoHookean(tissue, materials_of(tissue, std::vector(tissue.cells.size(), 0.4))), tissue, size_um,
                    1);
  check_derivatives(ShapeMemory(tissue, {.stiffness = 8}, 0), tissue, size_um, 1);
  check_derivatives(CornerBarrier(tissue, 0.4, 3), tissue, size_um / 2, 1);
  check_derivatives(Dilatation(tissue, in_elements(tissue, 3.0), false), tissue, size_um, 1);
  std::vector<double> pressures;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) pressures.push_back(c % 3 == 0 ? 0.7 : -0.4);
  check_derivatives(ConstraintLaw(CellVolumes(tissue), pressures), tissue, size_um, 1);
  check_derivatives(ConstraintLaw(EnclosedVolume(tissue), {0.7}), tissue, size_um, 1);
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    check_derivatives(Cortex(tissue, all, {.side = side, .tension = 1.4, .saturation = 0.16, .stiffness = 0.7}), tissue,
                      size_um, 1);
    check_derivatives(
        Contraction(contraction_springs(
                        tissue, all, {.side = side, .stiffness = 2, .across_ratio = 0.4, .preload = 1, .damping = 0.5}),
                    {}),
        tissue, size_um, 1);
  }
  check_derivatives(SurfaceDrag(tissue, 0.14), tissue, size_um, 1);
}

/// What springs carry per width of a sheet's cells, from the sum over them of force times length times direction twice.
Mat3 stress_of(const std::vector<Spring>& springs, const Tissue& tissue, double area) {
  Mat3 sum = Mat3::Zero();
  for (const Spring& spring : springs) {
    const Vec3 way =
        tissue.rest_positions[spring.nodes.back().index()] - tissue.rest_positions[spring.nodes.front().index()];
    sum += spring.preload / way.norm() * way * way.transpose();
  }
  return sum / area;
}

TEST_P(LawsOnPolygons, ATensionIsThatOfTheSheet) {
  const Tissue flat = tissue_from_prisms(honeycomb(4, 4, 8, 20), GetParam(), 1);
  const std::vector<double> areas = face_areas(flat, CellSide::apical, flat.rest_positions);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  const auto of = [&](double across_ratio) {
    return stress_of(
        contraction_springs(flat, CellSet(flat.cells.size(), true), {.across_ratio = across_ratio, .tension = 1.5}),
        flat, area);
  };
  const Mat3 even = of(1);
  EXPECT_NEAR(even(0, 0), 1.5, 1e-12);
  EXPECT_NEAR(even(1, 1), 1.5, 1e-12);
  EXPECT_NEAR(even(0, 1), 0, 1e-12);
  // Where both ratios differ, hexagons cannot part them wholly: an edge at 30 degrees pulls both ways.
  const Mat3 along = of(0);
  EXPECT_NEAR(along(0, 0), 0.75 * 1.5, 1e-12);
  EXPECT_NEAR(along(1, 1), 0.25 * 1.5, 1e-12);
}

/// A square cell of a sheet of polygons, and the same cell of a grid: 2 x 2 x 1 elements each.
std::pair<Tissue, Tissue> squares() {
  PrismSheet square;
  square.apical = {{-5, -4, 6}, {5, -4, 6}, {5, 4, 6}, {-5, 4, 6}};
  square.cells = {{0, 1, 2, 3}};
  for (const Vec3& x : square.apical) square.basal.push_back(x - 12 * Vec3::UnitZ());
  return {
      tissue_from_prisms(square, PolygonSplit::kites, 1),
      build_block(
          {.length_um = 10, .width_um = 8, .cell_height_um = 12, .cells = {1, 1, 1}, .elements_per_cell = {2, 2, 1}})};
}

// Decision 5: a polygon with four corners, split into kites, is a cell of 2 x 2 elements.
TEST(ContractionOfKites, IsThatOfAGrid) {
  const auto [polygon, grid] = squares();
  const auto moved = [](const Vec3& x) {
    return Vec3(0.8 * x.x() + 0.01 * x.y() * x.y(), 0.7 * x.y() - 0.02 * x.x() * x.x(), x.z() + 0.03 * x.x() * x.y());
  };
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    const ContractionRule rule{side, 2, 1.5, 0.4, false, 0.3, 1, 3};
    const auto forces_on = [&](const Tissue& tissue) {
      Motion motion = at_rest(tissue);
      for (Vec3& x : motion.positions) x = moved(x);
      return forces_of(Contraction(contraction_springs(tissue, CellSet{true}, rule), {}), motion.step());
    };
    const Vectors of_polygon = forces_on(polygon), of_grid = forces_on(grid);
    for (std::size_t n = 0; n < polygon.node_count(); ++n)
      for (std::size_t m = 0; m < grid.node_count(); ++m)
        if (polygon.rest_positions[n].isApprox(grid.rest_positions[m])) {
          EXPECT_LE((of_polygon[n] - of_grid[m]).norm(), 1e-12 * largest(of_grid));
        }
  }
}

// No node of a face is slack: the film holds a free middle in its plane, and walls shorten between corners too.
TEST_P(LawsOnPolygons, ContractionPullsOnEveryFreeNodeOfAFace) {
  const Tissue flat = tissue_from_prisms(honeycomb(3, 3, 8, 20), GetParam(), 1);
  const CellSet cells(flat.cells.size(), true);
  int cases = 0;
  for (const CellSide side : {CellSide::apical, CellSide::lateral}) {
    const Contraction law(contraction_springs(flat, cells, {.side = side, .stiffness = 1}), {});
    for (std::size_t n = 0; n < flat.free_node_count(); ++n) {
      const bool is_middle = std::ranges::none_of(flat.cells, [&](const Cell& cell) {
        return std::ranges::any_of(cell.edges, [&](const CellEdge& edge) {
          return std::ranges::find(edge.nodes, NodeId(n)) != edge.nodes.end();
        });
      });
      if (flat.rest_positions[n].z() != 0 || (is_middle && side == CellSide::lateral)) continue;
      Motion motion = at_rest(flat);
      motion.positions[n].z() += 1;
      EXPECT_LT(forces_of(law, motion.step())[n].z(), -0.1) << "node " << n;
      ++cases;
    }
  }
  EXPECT_GT(cases, 50);
}

// The energy of an even stretch is that of the edges: kites and diagonals have one.
TEST(ContractionOfKites, HasTheEnergyOfTheEdges) {
  const PrismSheet sheet = irregular_polygons(4, 4, 8, 20, 0.1, 3);
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    std::vector<double> energies;
    for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites}) {
      const Tissue tissue = tissue_from_prisms(sheet, split, 2);
      Motion motion = at_rest(tissue);
      for (Vec3& x : motion.positions) x = Vec3(0.7 * x.x(), 0.7 * x.y(), 0.8 * x.z());
      const ContractionRule rule{.side = side, .stiffness = 2, .rest_length_ratio = 0.3, .preload = 9, .damping = 3};
      energies.push_back(
          Contraction(contraction_springs(tissue, CellSet(tissue.cells.size(), true), rule), {}).energy(motion.step()));
    }
    EXPECT_NEAR(energies[1], energies[0], 1e-12 * energies[0]);
  }
}

TEST_P(LawsOnPolygons, OwnStateIsThatOfTheWholeCell) {
  const Mat3 stretch = Vec3(1.3, 0.8, 1.1).asDiagonal();
  const Tissue flat = tissue_from_prisms(irregular_polygons(4, 4, 8, 20, 0.1, 3), GetParam(), 1);
  Vectors x = flat.rest_positions;
  for (Vec3& one : x) one = stretch * one;
  const auto expect_all = [&](ShapeMeasure measure, double expected) {
    const ShapeActivation state(flat,
                                {.kind = ShapeActivationRule::Kind::starts_below, .measure = measure, .threshold = 1});
    for (const double ratio : state.ratios(x)) EXPECT_NEAR(ratio, expected, 1e-12);
  };
  expect_all(ShapeMeasure::apical_stretch, 1.3);
  expect_all(ShapeMeasure::apical_area_ratio, 1.3 * 0.8);
  expect_all(ShapeMeasure::height_ratio, 1.1);
}

TEST_P(LawsOnPolygons, ContactKnowsThem) {
  const SelfContact contact(tissue, {});
  double area = 0;
  for (const SelfContact::Point& point : contact.points()) area += point.area;
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
  EXPECT_NEAR(area, std::accumulate(areas.begin(), areas.end(), 0.0), 1e-9 * area);
}

constexpr std::size_t passive_laws = 3;  // the first of

std::vector<std::unique_ptr<Law>> laws_on(const Tissue& tissue) {
  const CellSet all(tissue.cells.size(), true);
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Corotational>(tissue, in_elements(tissue, ElasticModuli::from_young(1, 0.3)), 2));
  laws.push_back(std::make_unique<Dilatation>(tissue, in_elements(tissue, 3.0), false));
  laws.push_back(std::make_unique<NeoHookean>(tissue, materials_of(tissue, std::vector(tissue.cells.size(), 0.4))));
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    laws.push_back(std::make_unique<Cortex>(
        tissue, all, CortexRule{.side = side, .tension = 1.4, .saturation = 0.16, .stiffness = 0.7}));
    laws.push_back(std::make_unique<Contraction>(
        contraction_springs(tissue, all, {.side = side, .stiffness = 2, .across_ratio = 0.4, .preload = 1}),
        Program{}));
  }
  return laws;
}

class PeriodicLaws : public testing::TestWithParam<PolygonSplit> {
 protected:
  const Tissue tissue = build_sheet({40, 40, {0, 0}, {true, true}}, 20, 1, {10, GetParam(), 1});

  // Free nodes moved at random, and all others with them.
  [[nodiscard]] Vectors moved(double size_um, unsigned seed) const {
    Vectors x = tissue.rest_positions;
    Random random(seed);
    for (std::size_t n = 0; n < tissue.free_node_count(); ++n) x[n] += random.vector(size_um);
    tissue.place_hanging_positions(x);
    return x;
  }
  [[nodiscard]] Vectors carried_forces(const Law& law, const Step& step) const {
    Vectors forces(tissue.node_count(), Vec3::Zero());
    law.add_forces(step, forces);
    tissue.carry_hanging(forces);
    return forces;
  }
};

INSTANTIATE_TEST_SUITE_P(Splits, PeriodicLaws, testing::Values(PolygonSplit::diagonals, PolygonSplit::kites),
                         [](const auto& given) { return given.param == PolygonSplit::kites ? "kites" : "diagonals"; });

TEST_P(PeriodicLaws, DerivativesAgreeWithFiniteDifferences) {
  const CellSet all(tissue.cells.size(), true);
  check_derivatives(Cortex(tissue, all, {.side = CellSide::lateral, .tension = 1.4, .stiffness = 0.7}), tissue, 0.3, 1);
  check_derivatives(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(1, 0.45)), 2), tissue, 0.3, 1);
}

// The energy's change with a free node, whose images go along, is what is carried to it.
TEST_P(PeriodicLaws, ForcesThroughImagesAreMinusTheEnergysGradient) {
  int compared = 0;
  for (const auto& law : laws_on(tissue)) {
    Motion motion{moved(0.3, 1), tissue.rest_positions, Vectors(tissue.node_count(), Vec3::Zero())};
    const Vectors forces = carried_forces(*law, motion.step());
    const double scale = largest(forces);
    for (std::size_t n = 0; n < tissue.free_node_count(); n += 3)
      for (int axis = 0; axis < 3; ++axis, ++compared) {
        const auto energy_at = [&](double way) {
          Motion other = motion;
          other.positions[n][axis] += way;
          tissue.place_hanging_positions(other.positions);
          return law->energy(other.step());
        };
        const double difference = (energy_at(difference_um) - energy_at(-difference_um)) / (2 * difference_um);
        EXPECT_NEAR(forces[n][axis], -difference, 1e-6 * scale) << law->name() << ", node " << n;
      }
  }
  std::printf("%d components of forces\n", compared);
}

TEST_P(PeriodicLaws, NothingPushesTheWholeAndRestIsWithoutForce) {
  const Vectors still(tissue.node_count(), Vec3::Zero());
  const Motion motion{moved(0.5, 2), tissue.rest_positions, still};
  const Motion rest{tissue.rest_positions, tissue.rest_positions, still};
  const auto laws = laws_on(tissue);
  for (std::size_t l = 0; l < laws.size(); ++l) {
    const Vectors forces = carried_forces(*laws[l], motion.step());
    EXPECT_LT(resultant(forces).norm(), 1e-12 * largest(forces) * static_cast<double>(forces.size())) << l;
    if (l < passive_laws) {
      EXPECT_LT(largest(carried_forces(*laws[l], rest.step())), 1e-11) << l;
    }
  }
}

// A wall of two cells has one tension, where a period ends as elsewhere.
TEST_P(PeriodicLaws, AWallAcrossTheEndIsOne) {
  const Vectors still(tissue.node_count(), Vec3::Zero());
  const Motion rest{tissue.rest_positions, tissue.rest_positions, still};
  double perimeters = 0;
  for (const Cell& cell : tissue.cells)
    for (std::size_t i = 0; i < cell.sides(); ++i)
      perimeters += (tissue.rest_positions[cell.apical_corners()[(i + 1) % cell.sides()].index()] -
                     tissue.rest_positions[cell.apical_corners()[i].index()])
                        .norm();
  const Cortex walls(tissue, CellSet(tissue.cells.size(), true), {.side = CellSide::lateral, .tension = 1.5});
  EXPECT_NEAR(walls.energy(rest.step()), 1.5 * 0.5 * perimeters * 10, 1e-9 * perimeters);
}

// The area of a flat endless sheet does not change with its nodes: an even tension pulls at none. At a rim it does.
TEST_P(PeriodicLaws, AnEvenTensionPullsAtNoNode) {
  const auto pull = [&](const Tissue& sheet) {
    const Cortex cortex(sheet, CellSet(sheet.cells.size(), true), {.side = CellSide::apical, .tension = 1});
    Vectors forces(sheet.node_count(), Vec3::Zero());
    const Vectors still(sheet.node_count(), Vec3::Zero());
    cortex.add_forces(Motion{sheet.rest_positions, sheet.rest_positions, still}.step(), forces);
    sheet.carry_hanging(forces);
    return largest(forces);
  };
  EXPECT_LT(pull(tissue), 1e-12);
  EXPECT_GT(pull(build_sheet({40, 40}, 20, 1, {10, GetParam(), 1})), 1);
}

}  // namespace
