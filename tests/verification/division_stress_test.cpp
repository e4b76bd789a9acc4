// Random cells of the pill divide in random planes, five rounds, to over 10 000 cells; the tissue relaxes in between.
// Volumes: the paper's scaling of an octahedron, the same for plica's hexahedra, and volumes that add up.
#include "mechanics/constraints/cell_volume.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/divided.hpp"
#include "support/loads.hpp"

namespace {

// Contraction keeps the sheet moving and bent, so that cuts meet deformed cells.
Model contracting_pill() {
  Model model(build_shell({.length_um = 460, .cells = {18, 9, 8}}));
  add_elasticity(model);
  CellSet furrow(model.tissue.cells.size());
  for (std::size_t c = 0; c < furrow.size(); ++c)
    furrow[c] = model.tissue.cells[c].grid_place->face == GridPlace::Face::ventral;
  auto law = std::make_unique<Contraction>(
      contraction_springs(model.tissue, furrow, {.stiffness = 3, .across_ratio = 0.4}), Program{});
  model.laws.push_back(std::move(law));
  add_drag(model);
  return model;
}

TEST(DivisionStress, FiveRandomRoundsToTenThousandCells) {
  Model model = contracting_pill();
  State state = rest_state(model), next;
  Random random(20261121);
  for (int round = 1; round <= 5; ++round) {
    divide_cells(model, state, random_divisions(model.tissue, 0.7, random));
    NewtonStepper solver(model);
    double worst_volume = 0, worst_jacobian = 1;
    for (const double duration_s : {0.5, 5.0, 20.0}) {
      const StepReport report = solver.advance(state, duration_s, false, next);
      ASSERT_TRUE(report.converged()) << report.reason() << " in round " << round;
      state = next;
      for (const double error : model.volumes.relative_errors(state.positions))
        worst_volume = std::max(worst_volume, std::abs(error));
    }
    for (const auto& element : model.tissue.elements)
      worst_jacobian = std::min(worst_jacobian, hex_scaled_jacobian(gather(state.positions, element)));
    for (const Vec3& x : state.positions) ASSERT_TRUE(x.allFinite());
    EXPECT_LE(worst_volume, 1e-9);
    EXPECT_GT(worst_jacobian, 0);
    EXPECT_NEAR(volume_of_cells(model.tissue, state.positions) / volume_inside_boundary(model.tissue, state.positions),
                1, 1e-12);
    std::cout << "round " << round << ": " << model.tissue.cells.size() << " cells, " << model.tissue.elements.size()
              << " elements, " << model.tissue.free_node_count() << " free and " << model.tissue.hanging.size()
              << " hanging nodes; volumes to " << worst_volume << ", scaled Jacobian from " << worst_jacobian << "\n";
  }
  EXPECT_GT(model.tissue.cells.size(), 10000u);
}

// A sheet held at one end and bent by a small load at the other, volumes held: as soft after each round of divisions as
// before. Were the new nodes to hang on the neighbours' edges, each division would add a volume and no freedom.
double deflection(Model& model, State state) {
  const double left = -80, right = 80;
  Vectors loads(model.tissue.node_count(), Vec3::Zero());
  std::vector<NodeId> end;
  for (std::size_t n = 0; n < model.tissue.free_node_count(); ++n) {
    const Vec3& x = model.tissue.rest_positions[n];
    if (x.x() < left + 1e-6) model.held[n] = {true, true, true};
    if (x.x() > right - 1e-6) end.emplace_back(n);
  }
  for (const NodeId node : end) loads[node.index()] = Vec3(0, 0, 0.1 / static_cast<double>(end.size()));
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  NewtonStepper solver(model);
  State next;
  for (int step = 0; step < 3; ++step) {
    const StepReport report = solver.advance(state, 1e7, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    state = next;
  }
  double sum = 0;
  for (const NodeId node : end)
    sum += state.positions[node.index()].z() - model.tissue.rest_positions[node.index()].z();
  model.laws.pop_back();
  return sum / static_cast<double>(end.size());
}

TEST(DivisionStress, TheSheetDoesNotStiffen) {
  Model model(build_block({.length_um = 160, .width_um = 60, .cell_height_um = 40, .cells = {8, 3, 1}}));
  add_elasticity(model);
  add_drag(model);
  State state = rest_state(model);
  Random random(3);
  const double before = deflection(model, state);
  for (int round = 1; round <= 4; ++round) {
    divide_cells(model, state, random_divisions(model.tissue, 0.6, random));
    const double now = deflection(model, state);
    EXPECT_GT(now / before, 0.99) << "round " << round;
    EXPECT_LT(now / before, 1.2) << "round " << round;
    std::cout << "round " << round << ", " << model.tissue.cells.size() << " cells: deflection " << now / before
              << " of that of the undivided sheet\n";
  }
}

// ---- A body of triangles, volume as the sum of cones: what the paper's Eq. 2 is about.

struct Triangles {
  Vectors points;
  std::vector<std::array<int, 3>> faces;  // counter-clockwise from outside
};

Triangles octahedron(double radius) {
  Triangles body;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) body.points.push_back(sign * radius * Vec3::Unit(axis));
  for (const int x : {0, 1})
    for (const int y : {2, 3})
      for (const int z : {4, 5}) {
        const bool turned = (x + y + z) % 2 == 1;  // an odd number of negative axes
        body.faces.push_back(turned ? std::array<int, 3>{x, z, y} : std::array<int, 3>{x, y, z});
      }
  return body;
}

double volume(const Triangles& body) {
  double six_volumes = 0;
  for (const auto& [a, b, c] : body.faces) six_volumes += body.points[a].dot(body.points[b].cross(body.points[c]));
  return six_volumes / 6;
}

Vectors volume_gradient(const Triangles& body) {
  Vectors gradient(body.points.size(), Vec3::Zero());
  for (const auto& [a, b, c] : body.faces) {
    gradient[a] += body.points[b].cross(body.points[c]) / 6;
    gradient[b] += body.points[c].cross(body.points[a]) / 6;
    gradient[c] += body.points[a].cross(body.points[b]) / 6;
  }
  return gradient;
}

TEST(Volume, OctahedronIsScaledBackByOneStepAlongItsGradient) {
  // Unit octahedron: V = 4/3, so alpha = 3 V / (n R^2) = 4 / 6.
  EXPECT_NEAR(3 * volume(octahedron(1)) / 6, 2.0 / 3, 1e-15);
  for (const double radius : {0.7, 1.0, 1.3, 20.0}) {
    Triangles body = octahedron(radius);
    const double v = volume(body), target = volume(octahedron(1));
    EXPECT_NEAR(v, 4.0 / 3 * radius * radius * radius, 1e-12 * v);
    const double alpha = 3 * v / (6 * radius * radius);
    const double lambda = (std::cbrt(target / v) - 1) / alpha;
    const Vectors gradient = volume_gradient(body);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_LE((gradient[i] - alpha * body.points[i]).norm(), 1e-12 * radius * alpha);
      body.points[i] += lambda * gradient[i];
    }
    EXPECT_NEAR(volume(body), target, 1e-13 * std::max(v, target));
    for (const Vec3& x : body.points) EXPECT_NEAR(x.norm(), 1, 1e-13);
  }
}

// A cube of half-diagonal R: by symmetry dV/dx = alpha x, and sum x . dV/dx = 3 V gives alpha = 3 V / (8 R^2).
TEST(Volume, CubeIsScaledBackByOneStepAlongItsGradient) {
  for (const double radius : {0.7, 1.0, 1.3, 20.0}) {
    HexPoints cube = hex_reference_nodes;
    for (Vec3& x : cube) x *= radius / std::sqrt(3.0);
    const double v = hex_volume(cube), target = 8 / (3 * std::sqrt(3.0));
    const double alpha = 3 * v / (8 * radius * radius);
    const double lambda = (std::cbrt(target / v) - 1) / alpha;
    const auto gradient = hex_volume_gradient(cube);
    for (int i = 0; i < 8; ++i) {
      EXPECT_LE((gradient[i] - alpha * cube[i]).norm(), 1e-12 * radius * alpha);
      cube[i] += lambda * gradient[i];
    }
    EXPECT_NEAR(hex_volume(cube), target, 1e-13 * std::max(v, target));
  }
}

// ---- Volumes of neighbours.

/// Volume of the cone from the origin over a bilinear facet: a third of the integral of x . n dA, whose integrand is
/// quadratic in either parameter, so that 2 x 2 Gauss points are exact.
double cone(const std::array<Vec3, 4>& p) {
  const double g = 1 / std::sqrt(3.0);
  double sum = 0;
  for (const double s : {-g, g})
    for (const double t : {-g, g}) {
      const Vec3 x = 0.25 * ((1 - s) * (1 - t) * p[0] + (1 + s) * (1 - t) * p[1] + (1 + s) * (1 + t) * p[2] +
                             (1 - s) * (1 + t) * p[3]);
      const Vec3 by_s = 0.25 * ((1 - t) * (p[1] - p[0]) + (1 + t) * (p[2] - p[3]));
      const Vec3 by_t = 0.25 * ((1 - s) * (p[3] - p[0]) + (1 + s) * (p[2] - p[1]));
      sum += x.dot(by_s.cross(by_t)) / 3;
    }
  return sum;
}

/// Volume inside the faces that belong to one element only.
double volume_inside_faces(const Tissue& tissue, const Vectors& positions) {
  std::map<std::array<int, 4>, std::pair<int, std::array<NodeId, 4>>> faces;
  for (const auto& element : tissue.elements)
    for (const auto& face : hex_faces) {
      std::array<NodeId, 4> nodes;
      std::array<int, 4> key;
      for (int i = 0; i < 4; ++i) {
        nodes[i] = element[face[i]];
        key[i] = nodes[i].number();
      }
      std::sort(key.begin(), key.end());
      auto& entry = faces[key];
      entry.first += 1;
      entry.second = nodes;
    }
  double sum = 0;
  for (const auto& [key, entry] : faces) {
    EXPECT_LE(entry.first, 2);
    if (entry.first != 1) continue;
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = positions[entry.second[i].index()];
    sum += cone(points);
  }
  return sum;
}

void expect_volumes_add_up(const Tissue& tissue, double size_um, const char* name) {
  double worst = 0;
  int cases = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x += random.vector(size_um);
    double sum = 0;
    for (const double v : CellVolumes(tissue).volumes(positions)) sum += v;
    worst = std::max(worst, std::abs(sum / volume_inside_faces(tissue, positions) - 1));
    ++cases;
  }
  std::printf("volumes of cells over volume inside the boundary, %s: off by %.1e in %d cases\n", name, worst, cases);
  EXPECT_LE(worst, 1e-12);
}

TEST(Volume, CellsOfABlockFillItExactly) {
  expect_volumes_add_up(
      build_block(
          {.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 2}, .elements_per_cell = {1, 2, 1}}),
      4, "perturbed block");
}

TEST(Volume, CellsOfThePillFillItExactly) { expect_volumes_add_up(build_shell({}), 3, "perturbed pill"); }

}  // namespace
