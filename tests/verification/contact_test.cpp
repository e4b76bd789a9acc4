// Two elastic balls pressed together, against Hertz: the force is 4/3 E* sqrt(R*) d^1.5 for an approach d, on a disc of
// radius sqrt(R* d). A quarter of two half balls, their flat sides held.
// Flat on flat: a block that is pressed on another has the same pressure all over its face, wherever it stands on the
// mesh of the other. Without Poisson's effect the stress is uniform: compression over height times Young's modulus.
// Contact's distances and the crossing test against another program's, the IPC Toolkit's: what
// contact_truth/make_truth.py wrote, some hundred cases of either, or 10 000 in a folder that PLICA_CONTACT_TRUTH
// names.
#include <cstdlib>

#include "measure/self_intersections.hpp"
#include "mechanics/contact/edge_pairs.hpp"
#include "mechanics/contact/self_contact.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/bodies.hpp"
#include "support/elements.hpp"
#include "support/models.hpp"

namespace {

constexpr double radius = 100, modulus = 1, poisson = 0.3;  // um, kPa
constexpr double begin = 0.2, stiffness = 20;               // of contact: um, kPa/um
constexpr double first_gap = 0.25;                          // between the poles

// From 0 to 1 in parts, the first as large as given, each larger than the last by the same factor.
std::vector<double> graded(int parts, double first) {
  const auto sum = [&](double growth, int of) { return first * (std::pow(growth, of) - 1) / (growth - 1); };
  double low = 1 + 1e-6, high = 4;
  for (int k = 0; k < 60; ++k) (sum((low + high) / 2, parts) < 1 ? low : high) = (low + high) / 2;
  std::vector<double> places = {0};
  for (int k = 1; k <= parts; ++k) places.push_back(k < parts ? sum(low, k) : 1);
  return places;
}

// A cube of half side 1 goes to a ball of radius 1, its sides to the sphere.
Vec3 on_ball(const Vec3& p) {
  const Vec3 s = p.cwiseProduct(p);
  return {p.x() * std::sqrt(1 - s.y() / 2 - s.z() / 2 + s.y() * s.z() / 3),
          p.y() * std::sqrt(1 - s.z() / 2 - s.x() / 2 + s.z() * s.x() / 3),
          p.z() * std::sqrt(1 - s.x() / 2 - s.y() / 2 + s.x() * s.y() / 3)};
}

// Elements of a half ball along each direction, and the size at the pole of the first, over the radius.
struct Mesh {
  int parts;
  double first;
};

struct Pressed {
  double approach, force, radius;  // um, nN, um: of whole balls
};

std::vector<Pressed> press(const Mesh& below, const Mesh& above, const std::vector<double>& approaches) {
  const auto ball = [](const Mesh& mesh) {
    return [places = graded(mesh.parts, mesh.first), last = mesh.parts](int i, int j, int k) {
      return Vec3(radius * on_ball({places[i], places[j], 1 - places[last - k]}));
    };
  };
  Bodies bodies;
  bodies.add({below.parts, below.parts, below.parts},
             [at = ball(below)](int i, int j, int k) { return Vec3(at(i, j, k) - radius * Vec3::UnitZ()); });
  const std::size_t upper =
      bodies.add({above.parts, above.parts, above.parts}, [at = ball(above)](int i, int j, int k) {
        const Vec3 x = at(j, i, k);  // turned upside down, not mirrored
        return Vec3(x.x(), x.y(), radius + first_gap - x.z());
      });
  Model model(bodies.tissue());
  const Tissue& tissue = model.tissue;
  model.volumes.hold(false);
  const ElasticModuli moduli = ElasticModuli::from_young(modulus, poisson);
  model.laws.push_back(std::make_unique<Corotational>(tissue, in_elements(tissue, moduli), 0));
  model.laws.push_back(std::make_unique<Dilatation>(tissue, in_elements(tissue, moduli.bulk_modulus()), false));
  model.laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-6));
  model.laws.push_back(std::make_unique<SelfContact>(tissue, SelfContactRule{CellSide::apical, begin, stiffness, 3}));
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& x = tissue.rest_positions[n];
    const bool on_flat_side = x.z() < 1e-9 - radius || x.z() > radius + first_gap - 1e-9;
    model.held[n] = {on_flat_side || x.x() < 1e-9, on_flat_side || x.y() < 1e-9, on_flat_side};
  }
  NewtonStepper stepper(model);
  State state = rest_state(model), next;
  double pressed = begin - first_gap;
  std::vector<Pressed> results;
  for (const double approach : approaches) {
    for (int step = 0; step < 3; ++step) {  // pairs lag by a step
      if (step == 0)
        for (std::size_t n = upper; n < tissue.node_count(); ++n) state.positions[n].z() -= approach - pressed;
      const StepReport report = stepper.advance(state, 1, true, next);
      EXPECT_TRUE(report.converged()) << report.reason();
      std::swap(state, next);
    }
    pressed = approach;
    const Motion at{state.positions, state.positions, state.velocities};
    Step last = at.step();
    last.internal = state.internals.back();
    const Vectors forces = forces_of(*model.laws.back(), last);
    double force = 0, moment = 0;
    for (std::size_t n = upper; n < forces.size(); ++n) {
      force += forces[n].z();
      moment += forces[n].z() * state.positions[n].head<2>().squaredNorm();
    }
    // Hertz's pressure has a mean square distance of 2/5 of the square of the radius.
    results.push_back({approach, 4 * force, std::sqrt(2.5 * moment / force)});
  }
  return results;
}

// Hertz's bodies are half spaces, whose parts deeper than the held sides give way, too: by this, on the axis under a
// point load (Boussinesq). Of balls that part is missing, and another is more: they are slender beside half spaces.
double deeper(double force) {
  return 2 * force * (1 + poisson) * (3 - 2 * poisson) / (2 * std::numbers::pi * modulus * radius);
}

TEST(Hertz, ForceAndRadiusByApproach) {
  const double joint_modulus = modulus / (2 * (1 - poisson * poisson)), joint_radius = radius / 2;
  double worst_of_last = 1;
  for (const auto& [below, above] : {std::pair(Mesh{8, 0.02}, Mesh{7, 0.025}), {Mesh{12, 0.01}, Mesh{11, 0.012}}}) {
    double worst = 0;
    for (const Pressed& found : press(below, above, {0.5, 1, 2})) {
      const double contact_radius = std::sqrt(joint_radius * found.approach),
                   force = 4. / 3 * joint_modulus * std::sqrt(joint_radius) * std::pow(found.approach, 1.5),
                   by_force = std::cbrt(0.75 * found.force * joint_radius / joint_modulus);
      std::printf(
          "elements of %.1f um, radius of contact %4.1f um: force %.4f of Hertz's by the approach (at most %.4f), "
          "radius %.4f of Hertz's by the force\n",
          radius * below.first, contact_radius, found.force / force, 1 + 1.5 * deeper(force) / found.approach,
          found.radius / by_force);
      EXPECT_GT(found.force / force, 1);
      EXPECT_LT(found.force / force, 1 + 1.5 * deeper(force) / found.approach);
      worst = std::max(worst, std::abs(found.radius / by_force - 1));
    }
    EXPECT_LT(worst, worst_of_last / 2);
    worst_of_last = worst;
  }
  EXPECT_LT(worst_of_last, 0.015);
}

constexpr double block_modulus = 1, height = 20, side = 40;             // kPa, um: of the block that is pressed
constexpr double flat_begin = 0.4, flat_stiffness = 5, press_um = 0.8;  // um, kPa/um, um

struct Block {
  int cells;      // across
  double side;    // um
  Vec3 at;        // of its middle, um
  double turned;  // about the vertical
};

std::size_t add_block(Bodies& bodies, const Block& block, bool upside_down) {
  const int n = block.cells;
  return bodies.add({n, n, 2}, [&, n](int i, int j, int k) {
    if (upside_down) std::swap(i, j);
    const Vec3 place(block.side * (1. * i / n - 0.5), block.side * (1. * j / n - 0.5), height * (1 - 0.5 * k));
    return Vec3(Eigen::AngleAxisd(block.turned, Vec3::UnitZ()) *
                    Vec3(place.x(), place.y(), upside_down ? place.z() : -place.z()) +
                block.at);
  });
}

struct Pressure {
  double mean, scatter;  // over that of a uniform stress; standard deviation over cells
};

// Of the cells of the upper block at the contact, by their strain.
Pressure pressure(const Block& below, const Block& above, bool rigid_below) {
  Bodies bodies;
  add_block(bodies, below, false);
  const std::size_t upper = add_block(bodies, above, true);
  Model model(bodies.tissue());
  const Tissue& tissue = model.tissue;
  model.volumes.hold(false);
  const ElasticModuli moduli = ElasticModuli::from_young(block_modulus, 0);
  model.laws.push_back(std::make_unique<Corotational>(tissue, in_elements(tissue, moduli), 0));
  model.laws.push_back(std::make_unique<Dilatation>(tissue, in_elements(tissue, moduli.bulk_modulus()), false));
  model.laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-5));
  model.laws.push_back(
      std::make_unique<SelfContact>(tissue, SelfContactRule{CellSide::apical, flat_begin, flat_stiffness, 6}));
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const double z = tissue.rest_positions[n].z();
    const bool is_held = z < 1e-9 - height || z > above.at.z() + height - 1e-9 || (rigid_below && n < upper);
    model.held[n] = {is_held, is_held, is_held};
  }
  NewtonStepper stepper(model);
  State state = rest_state(model), next;
  for (int step = 0; step < 4; ++step) {
    if (step == 0)
      for (std::size_t n = upper; n < tissue.node_count(); ++n)
        state.positions[n].z() -= above.at.z() - flat_begin + press_um;
    const StepReport report = stepper.advance(state, 10, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    std::swap(state, next);
  }
  // Springs in a row: the two blocks and what lies between them, pressed from either side.
  const double exact = press_um / (height / block_modulus * (rigid_below ? 1 : 2) + 1 / (2 * flat_stiffness));
  const auto n = static_cast<std::size_t>(above.cells), layer = (n + 1) * (n + 1);
  std::vector<double> found;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      double strain = 0;
      for (const std::size_t corner :
           {i + (n + 1) * j, i + 1 + (n + 1) * j, i + (n + 1) * (j + 1), i + 1 + (n + 1) * (j + 1)}) {
        const std::size_t inner = upper + layer + corner, outer = inner + layer;
        strain += 0.25 * (1 - (state.positions[inner].z() - state.positions[outer].z()) / (height / 2));
      }
      found.push_back(block_modulus * strain / exact);
    }
  Pressure result{0, 0};
  for (const double p : found) result.mean += p / static_cast<double>(found.size());
  for (const double p : found) result.scatter += std::pow(p - result.mean, 2) / static_cast<double>(found.size());
  result.scatter = std::sqrt(result.scatter);
  return result;
}

TEST(FlatContact, PressureDoesNotDependOnTheMeshBelow) {
  for (const int cells : {5, 8}) {
    const Pressure found = pressure({7, side, Vec3::Zero(), 0}, {cells, side, {0, 0, 0.5}, 0}, false);
    std::printf("%d x %d cells on 7 x 7: mean %.4f, scatter %.4f\n", cells, cells, found.mean, found.scatter);
    EXPECT_NEAR(found.mean, 1, 1e-3);
    EXPECT_LT(found.scatter, 0.005);
  }
}

// Of stiff blocks at a given distance, over that of the area that lies over the other's.
double push(const Vec3& at, double turned) {
  Bodies bodies;
  add_block(bodies, {14, 90, Vec3::Zero(), 0}, false);
  const std::size_t upper = add_block(bodies, {8, side, at, turned}, true);
  const Tissue tissue = bodies.tissue();
  const SelfContact law(tissue, SelfContactRule{CellSide::apical, flat_begin, flat_stiffness, 6});
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  const double nearer = at.z() - flat_begin + 0.1;
  for (std::size_t n = upper; n < tissue.node_count(); ++n) motion.positions[n].z() -= nearer;
  return sum_from(forces_of(law, motion.step()), upper).z() / (2 * flat_stiffness * 0.1 * side * side);
}

TEST(FlatContact, PressureDoesNotDependOnSliding) {
  Random random(1);
  int cases = 0;
  for (; cases < 8; ++cases) {
    const Vec3 at(random.number(4), random.number(4), 0.5);
    const double turned = cases < 4 ? 0 : random.number(1);
    const Pressure found = pressure({14, 90, Vec3::Zero(), 0}, {8, side, at, turned}, true);
    const double of_stiff = push(at, turned);
    std::printf("at %5.2f %5.2f um, turned %5.2f: mean %.4f, scatter %.4f; push of stiff blocks %.4f\n", at.x(), at.y(),
                turned, found.mean, found.scatter, of_stiff);
    EXPECT_NEAR(found.mean, 1, 1e-3);
    EXPECT_LT(found.scatter, 0.005);
    // Points of the larger face count with all of their area, or not at all: at the rim, by half of a cell.
    EXPECT_NEAR(of_stiff, 1, 0.06);
  }
  RecordProperty("cases", cases);
}

struct Case {
  std::string kind;
  std::vector<double> numbers;

  [[nodiscard]] Vec3 vector(std::size_t k) const { return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]}; }
};

std::vector<Case> cases_of(const std::string& name) {
  const char* given = std::getenv("PLICA_CONTACT_TRUTH");
  std::ifstream file((given ? std::string(given) : PLICA_SOURCE_DIR "/tests/verification/contact_truth") + "/" + name);
  std::vector<Case> cases;
  for (std::string line; std::getline(file, line);) {
    std::stringstream fields(line);
    Case one;
    std::getline(fields, one.kind, ',');
    for (std::string number; std::getline(fields, number, ',');) one.numbers.push_back(std::stod(number));
    cases.push_back(std::move(one));
  }
  return cases;
}

TEST(ContactTruth, DistancesAndTheirGradients) {
  const std::vector<Case> cases = cases_of("point_triangle.csv");
  ASSERT_GE(cases.size(), 200u);
  struct Worst {
    double distance = 0, gradient = 0;
  };
  std::map<std::string, Worst> worst;  // over the size of the case
  for (const Case& one : cases) {
    const Vec3 p = one.vector(0), a = one.vector(1), b = one.vector(2), c = one.vector(3);
    const auto [weights, squared_distance] = closest_on_triangle(p, a, b, c);
    const double size = std::max({(p - a).norm(), (p - b).norm(), (p - c).norm(), (a - b).norm(), (a - c).norm()});
    for (const double weight : weights) {
      EXPECT_GE(weight, -1e-12) << one.kind;
      EXPECT_LE(weight, 1 + 1e-12) << one.kind;
    }
    EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1, 1e-12) << one.kind;
    if (size == 0) continue;
    Worst& here = worst[one.kind];
    here.distance = std::max(here.distance, std::abs(std::sqrt(squared_distance) - std::sqrt(one.numbers[12])) / size);
    // Of the squared distance: 2 (p - q) by the point, and -2 w (p - q) by a corner of weight w.
    const std::span<const double> gradient = std::span(one.numbers).subspan(13);
    const Vec3 from_triangle = p - weights[0] * a - weights[1] * b - weights[2] * c;
    const bool has_area = (b - a).cross(c - a).norm() > 0;
    for (int k = 0; k < (has_area ? 4 : 1); ++k) {
      const Vec3 ours = (k == 0 ? 2 : -2 * weights[k - 1]) * from_triangle;
      const Vec3 theirs(gradient[3 * k], gradient[3 * k + 1], gradient[3 * k + 2]);
      here.gradient = std::max(here.gradient, (ours - theirs).norm() / size);
    }
  }
  for (const auto& [kind, of_kind] : worst) {
    std::printf("%-15s distance %.1e, gradient %.1e of the size\n", kind.c_str(), of_kind.distance, of_kind.gradient);
    EXPECT_LE(of_kind.distance, 1e-9) << kind;
    EXPECT_LE(of_kind.gradient, 1e-9) << kind;
  }
  RecordProperty("cases", static_cast<int>(cases.size()));
}

TEST(ContactTruth, Crossings) {
  const std::vector<Case> cases = cases_of("facets.csv");
  ASSERT_GE(cases.size(), 200u);
  int crossing = 0, touching = 0, apart = 0;
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const Case& one = cases[n];
    std::array<Facet, 2> facets;
    Vectors positions;
    for (std::size_t k = 0; k < 8; ++k) {
      facets[k / 4].nodes[k % 4] = NodeId(k);
      positions.push_back(one.vector(k));
    }
    const bool cross = one.numbers[24] != 0, touch = one.numbers[25] != 0;
    ++(cross ? crossing : touch ? touching : apart);
    EXPECT_EQ(crossing_facets(facets, positions).size(), cross ? 1u : 0u) << one.kind << ", line " << n + 1;
  }
  std::printf("%d pairs cross, %d touch, %d are apart\n", crossing, touching, apart);
  EXPECT_GT(std::min({crossing, touching, apart}), 10);
}

}  // namespace
