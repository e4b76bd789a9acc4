// Two elastic balls pressed together, against Hertz: the force is 4/3 E* sqrt(R*) d^1.5 for an approach d, on a disc of
// radius sqrt(R* d). A quarter of two half balls, their flat sides held.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "mechanics/contact/self_contact.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/bodies.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

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
  model.laws.push_back(std::make_unique<Corotational>(tissue, moduli, 0));
  model.laws.push_back(std::make_unique<Dilatation>(tissue, moduli.bulk_modulus()));
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
  int cases = 0;
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
      ++cases;
    }
    EXPECT_LT(worst, worst_of_last / 2);
    worst_of_last = worst;
  }
  EXPECT_LT(worst_of_last, 0.015);
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
