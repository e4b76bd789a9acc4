// Flat on flat: a block that is pressed on another has the same pressure all over its face, wherever it stands on the
// mesh of the other. Without Poisson's effect the stress is uniform: compression over height times Young's modulus.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "mechanics/contact/self_contact.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/bodies.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double modulus = 1, height = 20, side = 40;      // kPa, um: of the block that is pressed
constexpr double begin = 0.4, stiffness = 5, press = 0.8;  // um, kPa/um, um

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
  const ElasticModuli moduli = ElasticModuli::from_young(modulus, 0);
  model.laws.push_back(std::make_unique<Corotational>(tissue, moduli, 0));
  model.laws.push_back(std::make_unique<Dilatation>(tissue, moduli.bulk_modulus()));
  model.laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-5));
  model.laws.push_back(std::make_unique<SelfContact>(tissue, SelfContactRule{CellSide::apical, begin, stiffness, 6}));
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const double z = tissue.rest_positions[n].z();
    const bool is_held = z < 1e-9 - height || z > above.at.z() + height - 1e-9 || (rigid_below && n < upper);
    model.held[n] = {is_held, is_held, is_held};
  }
  NewtonStepper stepper(model);
  State state = rest_state(model), next;
  for (int step = 0; step < 4; ++step) {
    if (step == 0)
      for (std::size_t n = upper; n < tissue.node_count(); ++n) state.positions[n].z() -= above.at.z() - begin + press;
    const StepReport report = stepper.advance(state, 10, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    std::swap(state, next);
  }
  // Springs in a row: the two blocks and what lies between them, pressed from either side.
  const double exact = press / (height / modulus * (rigid_below ? 1 : 2) + 1 / (2 * stiffness));
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
      found.push_back(modulus * strain / exact);
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
  const SelfContact law(tissue, SelfContactRule{CellSide::apical, begin, stiffness, 6});
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  const double nearer = at.z() - begin + 0.1;
  for (std::size_t n = upper; n < tissue.node_count(); ++n) motion.positions[n].z() -= nearer;
  return sum_from(forces_of(law, motion.step()), upper).z() / (2 * stiffness * 0.1 * side * side);
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

}  // namespace
}  // namespace plica
