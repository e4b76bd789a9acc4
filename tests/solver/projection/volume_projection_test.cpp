// Projection onto held volumes: closed surfaces, roots of cubics, moves of nodes.
#include "solver/projection/volume_projection.hpp"

#include <Eigen/Dense>

#include "mechanics/constraints/cell_volume.hpp"
#include "support/models.hpp"

namespace {

constexpr double duration_s = 2;

/// At rest but for the nodes, which lie elsewhere.
State moved_to(const Model& model, Vectors positions) {
  State state = rest_state(model);
  state.positions = std::move(positions);
  return state;
}

Vectors shaken(const Model& model, double size_um, unsigned seed) {
  Random random(seed);
  Vectors positions = model.tissue.rest_positions;
  for (Vec3& x : positions) x += random.vector(size_um);
  return positions;
}

StepReport project(const Model& model, const ProjectionRule& rule, State& state) {
  const State before = rest_state(model);
  StepReport report;
  VolumeProjection(model, rule).apply(before, duration_s, {}, state, report);
  return report;
}

double worst_error(const Model& model, const Vectors& positions) {
  double worst = 0;
  for (const double error : model.volumes.relative_errors(positions)) worst = std::max(worst, std::abs(error));
  return worst;
}

/// What a projection moved, times the nodes' drag where that is asked for.
Vectors displacements(const Model& model, const Vectors& before, const State& after, bool times_drag) {
  Vectors moved(before.size()), weight(before.size(), Vec3::Ones());
  if (times_drag) {
    std::fill(weight.begin(), weight.end(), Vec3::Zero());
    const Step step{before, before, before, 1, 0};
    SurfaceDrag(model.tissue, usual_drag).add_tangent_product(step, Vectors(before.size(), Vec3::Ones()), weight);
  }
  for (std::size_t n = 0; n < before.size(); ++n) moved[n] = weight[n].cwiseProduct(after.positions[n] - before[n]);
  return moved;
}

Vec3 sum_of(const Vectors& vectors) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : vectors) sum += v;
  return sum;
}

Model single_cube() {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  add_drag(model);
  return model;
}

// A cube blown up by 3 % comes back as a cube, by l = ((V0/V)^(1/3) - 1)/a, a = s/2.
TEST(VolumeProjection, BlownUpCubeIsScaledBackInOneMove) {
  const Model model = single_cube();
  Vectors positions = model.tissue.rest_positions;
  for (Vec3& x : positions) x *= 1.01;
  State state = moved_to(model, positions);
  const StepReport report = project(model, {}, state);
  ASSERT_TRUE(report.converged());
  EXPECT_EQ(report.cubics, 1);
  EXPECT_EQ(report.cubics_with_three_roots, 0);
  EXPECT_EQ(report.projection_sweeps, 2);  // the second finds nothing to do
  const Vec3 shift = sum_of(displacements(model, model.tissue.rest_positions, state, false)) / 8;
  EXPECT_LE(shift.norm(), 1e-12);
  for (std::size_t n = 0; n < 8; ++n) EXPECT_LE((state.positions[n] - model.tissue.rest_positions[n]).norm(), 1e-7);
  // Its pressure: l over the step, with the mean of the nodes' mobility.
  const double l = (1 / 1.01 - 1) / 10.1, mean_drag = usual_drag * 2 * 400 / 8;
  EXPECT_NEAR(state.multipliers[0], l * mean_drag / duration_s, 1e-9 * std::abs(state.multipliers[0]));
}

// X + l dV/dX moves no cell as a whole and turns none: the gradient has neither resultant nor moment.
TEST(VolumeProjection, EqualWeightsKeepCentreAndMomentOfAFreeBody) {
  const Model model = single_cube();
  const Vectors before = shaken(model, 2, 1);
  State state = moved_to(model, before);
  ASSERT_TRUE(project(model, {}, state).converged());
  const Vectors moved = displacements(model, before, state, false);
  EXPECT_GT(largest(moved), 0.01);
  EXPECT_LE(sum_of(moved).norm(), 1e-12);
  Vec3 moment = Vec3::Zero();
  for (std::size_t n = 0; n < moved.size(); ++n) moment += before[n].cross(moved[n]);
  EXPECT_LE(moment.norm(), 1e-11);
}

// By mobility it is the drag-weighted sum that stays, which is what forces without resultant leave alone.
TEST(VolumeProjection, WeightsDecideWhichSumOfASheetStays) {
  const Model model = dimpling_sheet();
  const Vectors before = shaken(model, 2, 2);
  for (const auto weights : {ProjectionRule::Weights::equal, ProjectionRule::Weights::mobility}) {
    State state = moved_to(model, before);
    const StepReport report = project(model, {.weights = weights}, state);
    ASSERT_TRUE(report.converged()) << report.reason();
    EXPECT_LE(worst_error(model, state.positions), 1e-9);
    const bool mobility = weights == ProjectionRule::Weights::mobility;
    const Vectors plain = displacements(model, before, state, false),
                  dragged = displacements(model, before, state, true);
    EXPECT_LE(sum_of(mobility ? dragged : plain).norm(), 1e-10 * largest(mobility ? dragged : plain));
    EXPECT_GT(sum_of(mobility ? plain : dragged).norm(), 1e-3 * largest(mobility ? plain : dragged));
  }
}

TEST(VolumeProjection, HeldDirectionsStay) {
  Model model = dimpling_sheet();
  for (std::size_t n = 0; n < model.held.size(); n += 3) model.held[n] = {true, false, n % 2 == 0};
  const Vectors before = shaken(model, 1, 3);
  State state = moved_to(model, before);
  ASSERT_TRUE(project(model, {}, state).converged());
  EXPECT_LE(worst_error(model, state.positions), 1e-9);
  for (std::size_t n = 0; n < before.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        EXPECT_EQ(state.positions[n][axis], before[n][axis]);
      }
}

TEST(VolumeProjection, ACellThatCannotMoveIsNamed) {
  Model model = dimpling_sheet();
  const auto& element = model.tissue.elements[5];
  for (const NodeId node : element) model.held[node.index()] = {true, true, true};
  Vectors positions = model.tissue.rest_positions;
  positions[element[6].index()].z() += 1;
  State state = moved_to(model, positions);
  const StepReport report = project(model, {.most_sweeps = 20}, state);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  ASSERT_TRUE(report.cell);
  EXPECT_EQ(report.cell->index(), 5u);
  EXPECT_EQ(report.projection_sweeps, 20);
  EXPECT_SAYS(report.reason(), "cell 5");
}

// One volume around all: its cells may differ, their sum may not.
TEST(VolumeProjection, WholeSurfaces) {
  const Model model = furrowing_sphere();
  Vectors swollen = shaken(model, 0.5, 4);
  for (Vec3& x : swollen) x *= 0.98;
  State state = moved_to(model, swollen);
  StepReport report = project(model, {.surfaces = ProjectionRule::Surfaces::tissue}, state);
  ASSERT_TRUE(report.converged()) << report.reason();
  double volume = 0, target = 0;
  const std::vector<double> volumes = model.volumes.volumes(state.positions);
  for (std::size_t c = 0; c < volumes.size(); ++c) volume += volumes[c], target += model.volumes.targets()[c];
  EXPECT_NEAR(volume / target, 1, 1e-9);
  EXPECT_GT(worst_error(model, state.positions), 1e-3);

  // The apical surface fills its shell at rest: inside the shell its volume cannot be kept once it has folded in.
  state = moved_to(model, swollen);
  state.positions[0] *= 0.9;
  report = project(model, {.surfaces = ProjectionRule::Surfaces::embryo, .most_sweeps = 200}, state);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  EXPECT_FALSE(report.cell);
  EXPECT_FALSE(report.reason().empty());
}

// The end is the nearest place that obeys shell and volumes, so a start on another way comes to the same one, but for
// second order in what is moved: the gradients are those of the places passed.
TEST(VolumeProjection, ShellAndVolumesAreMetTogetherFromAnyStart) {
  const Model model = furrowing_sphere();
  double previous = 0;
  for (const double size : {0.4, 0.2, 0.1}) {
    const Vectors moved = shaken(model, size, 5);
    State cold = moved_to(model, moved), warm = moved_to(model, moved);
    ASSERT_TRUE(project(model, {}, cold).converged());
    State before = rest_state(model);
    for (std::size_t c = 0; c < before.multipliers.size(); ++c) before.multipliers[c] = 1.3 * cold.multipliers[c];
    for (double& force : before.obstacle_forces) force = 2 * size;
    StepReport report;
    VolumeProjection(model, ProjectionRule{}).apply(before, duration_s, {}, warm, report);
    ASSERT_TRUE(report.converged()) << report.reason();
    const double apart = largest_distance(warm.positions, cold.positions);
    for (const State* state : {&cold, &warm}) {
      EXPECT_LE(worst_error(model, state->positions), 1e-9);
      for (std::size_t k = 0; k < state->obstacle_forces.size(); ++k) {
        const double gap = ObstacleContacts(model).gap(k, state->positions).value;
        EXPECT_GE(gap, -1e-7);
        EXPECT_GE(state->obstacle_forces[k], 0);
        if (state->obstacle_forces[k] > 0) {
          EXPECT_LE(gap, 1e-7) << "a force at a distance";
        }
      }
    }
    std::printf("moved by up to %.1f um: two starts end %.1e um apart\n", size, apart);
    if (previous > 0) {
      EXPECT_LE(apart, 0.4 * previous);
    }
    previous = apart;
  }
  EXPECT_LE(previous, 1e-3);
}

std::vector<ClosedSurface::Quad> facets_of(const Tissue& tissue) {
  std::vector<ClosedSurface::Quad> facets;
  for (const auto& element : tissue.elements)
    for (const auto& f : hex_faces) facets.push_back({element[f[0]], element[f[1]], element[f[2]], element[f[3]]});
  return facets;
}

double volume(const ClosedSurface& surface, const Vectors& positions) {
  Vectors points, gradient;
  surface.gather(positions, points);
  surface.gradient(points, gradient);
  return dot(points, gradient) / 3;
}

/// The multiplier that scales a body whose gradient is radial back to `target`, and the volume there.
std::pair<double, double> scaled_back(const ClosedSurface& surface, Vectors positions, double target) {
  Vectors points, gradient, scratch;
  surface.gather(positions, points);
  surface.gradient(points, gradient);
  Cubic cubic = surface.volume_along(points, gradient, gradient, scratch);
  cubic.c0 -= target;
  const double l = root_nearest_zero(cubic).value();
  for (std::size_t i = 0; i < surface.nodes().size(); ++i) positions[surface.nodes()[i].index()] += l * gradient[i];
  return {l, volume(surface, positions)};
}

TEST(ClosedSurface, VolumeAndGradientAreTheHexahedrons) {
  const Tissue cell =
      distorted_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}, 4, 1);
  const ClosedSurface surface(facets_of(cell));
  const HexPoints points = gather(cell.rest_positions, cell.elements[0]);
  EXPECT_NEAR(volume(surface, cell.rest_positions), hex_volume(points), 1e-12 * hex_volume(points));
  Vectors local, gradient;
  surface.gather(cell.rest_positions, local);
  surface.gradient(local, gradient);
  const auto expected = hex_volume_gradient(points);
  for (int i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 8; ++k)
      if (surface.nodes()[k] == cell.elements[0][i]) {
        EXPECT_LE((gradient[k] - expected[i]).norm(), 1e-10);
      }
}

TEST(ClosedSurface, SharedFacetsCancel) {
  const Tissue block =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 2}}, 2, 1);
  const ClosedSurface surface(facets_of(block));
  double sum = 0;
  const CellVolumes volumes(block);
  for (const double of_cell : volumes.targets()) sum += of_cell;
  EXPECT_NEAR(volume(surface, block.rest_positions), sum, 1e-12 * sum);
  EXPECT_EQ(surface.nodes().size(), 36u - 2u);  // two nodes lie inside
}

TEST(ClosedSurface, VolumeAlongADirectionIsAnExactCubic) {
  const Tissue block =
      distorted_block({.length_um = 40, .width_um = 40, .cell_height_um = 40, .cells = {2, 2, 1}}, 3, 2);
  const ClosedSurface surface(facets_of(block));
  Random random(3);
  Vectors points, gradient, scratch;
  surface.gather(block.rest_positions, points);
  surface.gradient(points, gradient);
  for (int k = 0; k < 5; ++k) {
    const Vectors direction = random.vectors(surface.nodes().size(), 10);
    const Cubic cubic = surface.volume_along(points, gradient, direction, scratch);
    for (const double l : {-2.0, -0.1, 0.5, 3.0}) {
      Vectors moved = block.rest_positions;
      for (std::size_t i = 0; i < direction.size(); ++i) moved[surface.nodes()[i].index()] += l * direction[i];
      const double expected = volume(surface, moved);
      EXPECT_NEAR(cubic.at(l), expected, 1e-10 * (std::abs(expected) + 1e5));
    }
  }
}

// An octahedron of radius R has gradients radial at its 6 corners: dV/dx = a x, a = 3V/(6 R^2) = 2R/3, so V(l) =
// V (1 + a l)^3 and l = ((V0/V)^(1/3) - 1)/a.
TEST(ClosedSurface, OctahedronIsScaledBack) {
  for (const double radius : {1.0, 25.0}) {
    Vectors corners;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) corners.emplace_back(sign * radius * Vec3::Unit(axis));
    std::vector<ClosedSurface::Quad> facets;
    for (int x : {0, 1})
      for (int y : {2, 3})
        for (int z : {4, 5}) {
          const bool outward = (x + y + z) % 2 == 0;
          facets.push_back(outward ? ClosedSurface::Quad{NodeId(x), NodeId(y), NodeId(z), NodeId(z)}
                                   : ClosedSurface::Quad{NodeId(y), NodeId(x), NodeId(z), NodeId(z)});
        }
    const ClosedSurface octahedron(facets);
    const double V = volume(octahedron, corners), V0 = 0.7 * V, a = 3 * V / (6 * radius * radius);
    EXPECT_NEAR(V, 4 * std::pow(radius, 3) / 3, 1e-12 * V);
    EXPECT_NEAR(a, 2 * radius / 3, 1e-12 * a);
    const auto [l, reached] = scaled_back(octahedron, corners, V0);
    EXPECT_NEAR(l, (std::cbrt(V0 / V) - 1) / a, 1e-13 / a);
    EXPECT_NEAR(reached, V0, 1e-12 * V0);
  }
}

// The same with a cube of side s: 8 corners at s sqrt(3)/2, a = s/2.
TEST(ClosedSurface, CubeIsScaledBack) {
  const double side = 20, V0 = 9000;
  const Tissue cube = build_block({.length_um = side, .width_um = side, .cell_height_um = side, .cells = {1, 1, 1}});
  const auto [l, reached] = scaled_back(ClosedSurface(facets_of(cube)), cube.rest_positions, V0);
  EXPECT_NEAR(l, (std::cbrt(V0 / 8000) - 1) / (side / 2), 1e-15);
  EXPECT_NEAR(reached, V0, 1e-9);
}

// Each pair of a brick's faces moves apart on its own: V(l) = V (1 + l A/2)(1 + l B/2)(1 + l C/2) with A = bc/a and so
// on. The paper calls the real root unique. For a brick a x a x h it is as long as h < 2a; the cells are 20 x 20 x 40.
TEST(ClosedSurface, TallBricksHaveThreeRealRoots) {
  for (const auto& [height, three] : {std::pair{20.0, false}, {39.9, false}, {40.1, true}, {60.0, true}}) {
    const double a = 20;
    const Tissue brick = build_block({.length_um = a, .width_um = a, .cell_height_um = height, .cells = {1, 1, 1}});
    const ClosedSurface surface(facets_of(brick));
    Vectors points, gradient, scratch;
    surface.gather(brick.rest_positions, points);
    surface.gradient(points, gradient);
    Cubic cubic = surface.volume_along(points, gradient, gradient, scratch);
    for (const double l : {-0.01, 0.02, 0.3}) {
      const double expected = (a + l * a * height / 2) * (a + l * a * height / 2) * (height + l * a * a / 2);
      EXPECT_NEAR(cubic.at(l), expected, 1e-11 * expected);
    }
    cubic.c0 -= a * a * height * (1 + 1e-7);
    EXPECT_EQ(has_three_real_roots(cubic), three) << height;
  }
}

/// c (l - a)(l - b)(l - d), with c such that the slope at zero is positive.
Cubic with_roots(double a, double b, double d) {
  const double c = a * b + b * d + d * a > 0 ? 1 : -1;
  return {c, -c * (a + b + d), c * (a * b + b * d + d * a), -c * a * b * d};
}

TEST(Cubic, RootNearestZeroOfThreeIsFound) {
  for (const std::array<double, 3>& roots : {std::array<double, 3>{1, 2, 3},
                                             {-1, 2, 3},
                                             {-1, -2, -3},
                                             {0.5, -4, 7},
                                             {-0.1, 0.2, 50},
                                             {1e-9, 5, -8},
                                             {2, -1.5, 0.7},
                                             {3, -2.9, 40}}) {
    double nearest = roots[0];
    for (const double root : roots)
      if (std::abs(root) < std::abs(nearest)) nearest = root;
    const Cubic cubic = with_roots(roots[0], roots[1], roots[2]);
    ASSERT_GT(cubic.c1, 0);
    const auto found = root_nearest_zero(cubic);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, nearest, 1e-14 * std::abs(nearest)) << roots[0] << " " << roots[1] << " " << roots[2];
    EXPECT_TRUE(has_three_real_roots(cubic));
  }
}

// A volume that is off by 1e-9 of itself: formulas with cube roots leave no digit of this.
TEST(Cubic, TinyRootsKeepTheirDigits) {
  for (const double excess : {1e-3, 1e-9, 1e-15, -1e-12}) {
    const Cubic cubic{2, 30, 45, 45 * excess};
    const double root = root_nearest_zero(cubic).value();
    EXPECT_LE(std::abs(cubic.at(root)), 1e-14 * 45 * std::abs(excess));
    EXPECT_NEAR(root / -excess, 1, 2 * std::abs(excess) + 1e-14);  // the linear part's root and a first correction
  }
  EXPECT_EQ(root_nearest_zero({2, 30, 45, 0}).value(), 0);
}

TEST(Cubic, LowerDegreesAreSolvedToo) {
  EXPECT_DOUBLE_EQ(root_nearest_zero({0, 0, 4, -2}).value(), 0.5);
  EXPECT_NEAR(root_nearest_zero({0, 1, 4, 3}).value(), -1, 1e-14);
  EXPECT_FALSE(root_nearest_zero({0, 1, 1, 3}));
  EXPECT_FALSE(has_three_real_roots({0, 1, 4, 3}));
}

// Against the eigenvalues of the companion matrix.
TEST(Cubic, AgreesWithCompanionMatrix) {
  Random random(1);
  int three = 0, cases = 0;
  for (int k = 0; k < 2000; ++k) {
    const Cubic cubic{random.number(3), random.number(5), 0.01 + std::abs(random.number(4)), random.number(6)};
    Mat3 companion;
    companion << 0, 0, -cubic.c0 / cubic.c3, 1, 0, -cubic.c1 / cubic.c3, 0, 1, -cubic.c2 / cubic.c3;
    const Eigen::EigenSolver<Mat3> solver(companion, false);
    double nearest = INFINITY;
    int real = 0;
    bool doubtful = false;  // two roots about equal, or equally near: either answer is right
    for (int i = 0; i < 3; ++i) {
      const std::complex<double> root = solver.eigenvalues()[i];
      for (int j = 0; j < i; ++j) {
        doubtful = doubtful || std::abs(root - solver.eigenvalues()[j]) < 1e-5 * std::abs(root);
        doubtful = doubtful || std::abs(std::abs(root.real()) - std::abs(solver.eigenvalues()[j].real())) < 1e-9;
      }
      if (std::abs(root.imag()) > 1e-9 * std::abs(root)) continue;
      ++real;
      if (std::abs(root.real()) < std::abs(nearest)) nearest = root.real();
    }
    if (doubtful && real == 3) continue;
    EXPECT_NEAR(root_nearest_zero(cubic).value(), nearest, 1e-8 * std::abs(nearest));
    EXPECT_EQ(has_three_real_roots(cubic), real == 3);
    three += real == 3;
    ++cases;
  }
  std::printf("%d random cubics, %d with three real roots\n", cases, three);
  EXPECT_GT(cases, 1900);
  EXPECT_GT(three, 100);
}

}  // namespace
