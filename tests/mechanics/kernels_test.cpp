// Kernels of all instruction sets, compared with laws made of the formulas as they stand, an element at a time; and the
// chunks of elements that they take at once.
#include "mechanics/kernels/kernels.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "core/parallel.hpp"
#include "core/threads.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "tissue/tissue.hpp"

namespace {

const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);

// Corotational elasticity by the whole stiffness matrix.
class DenseCorotational final : public TurningElements {
 public:
  DenseCorotational(const Tissue& tissue, double shear_viscosity)
      : TurningElements(tissue, shear_viscosity > 0), viscosity_(shear_viscosity), stiffness_(elements_.size()) {
    for (std::size_t e = 0; e < elements_.size(); ++e) fit(tissue, e);
  }
  [[nodiscard]] std::string_view name() const override { return "dense"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<DenseCorotational>(*this); }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return nullptr;
  }

 private:
  void fit(const Tissue& tissue, std::size_t e) override {
    take_rest_shape(tissue, e);
    const HexPoints& rest = tissue.element_rest_shape[e];
    elements_[e].frame = mean_gradients(rest);
    Vec24 b;
    for (int i = 0; i < 8; ++i) b.segment<3>(3 * i) = elements_[e].frame[i];
    stiffness_[e] = incompatible_stiffness(rest, moduli) - moduli.bulk_modulus() * hex_volume(rest) * b * b.transpose();
    if (viscosity_ > 0) elements_[e].viscosity = incompatible_stiffness(rest, viscous_moduli(viscosity_));
  }
  double respond(std::size_t e, const Vec24& u, Vec24& q) const override {
    q = stiffness_[e] * u;
    return 0.5 * u.dot(q);
  }
  const Mat24& local_stiffness(std::size_t e, const Vec24&, Mat24&) const override { return stiffness_[e]; }

  double viscosity_;
  std::vector<Mat24> stiffness_;
};

// A distorted row of elements: one that fills no batch, or several and part of one.
Tissue row(int elements) {
  return distorted_block(
      {.length_um = 20.0 * elements, .width_um = 20, .cell_height_um = 40, .cells = {elements, 1, 1}}, 2, 31);
}

void expect_same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * b.cwiseAbs().maxCoeff());
}

// Energy, forces and both forms of the tangent of two laws.
void expect_same_law(const Law& law, const Law& reference, const Motion& motion, double tolerance) {
  const Step step = motion.step();
  EXPECT_NEAR(law.energy(step), reference.energy(step), tolerance * std::abs(reference.energy(step)));
  expect_same(flat(forces_of(law, step)), flat(forces_of(reference, step)), tolerance);
  const Vectors direction = Random(5).vectors(motion.positions.size());
  expect_same(product_of(law, step, direction), product_of(reference, step, direction), tolerance);
  expect_same(DenseTangent(law, step).matrix, DenseTangent(reference, step).matrix, tolerance);
}

// In modes, side by side: the same as by whole matrices, one after the other, but for rounding. 1e-12 is what is
// promised between instruction sets too.
TEST(Kernels, CorotationalElementsAreThoseOfTheWholeStiffness) {
  int cases = 0;
  for (const Kernels kernels : available_kernels())
    for (const int elements : {1, 3, 8, 11})
      for (const double viscosity : {0.0, 2.0})
        for (const bool semidefinite : {false, true}) {
          SCOPED_TRACE(::testing::Message()
                       << name(kernels) << ", " << elements << " elements, viscosity " << viscosity);
          const Tissue tissue = row(elements);
          Motion motion = random_motion(tissue, 4, static_cast<unsigned>(++cases));
          motion.semidefinite_tangent = semidefinite;
          expect_same_law(Corotational(tissue, in_elements(tissue, moduli), viscosity, kernels),
                          DenseCorotational(tissue, viscosity), motion, 1e-12);
        }
  std::printf("%d cases\n", cases);
}

TEST(Kernels, HourglassStiffnessIsWhatIsNotUniform) {
  Random random(8);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const HexPoints rest = distorted_block({.length_um = 20, .cells = {1, 1, 1}}, 4, seed).element_rest_shape[0];
    const std::array<Vec3, 8> b = mean_gradients(rest);
    Vec24 u;
    Mat3 gradient = Mat3::Zero();
    for (int i = 0; i < 8; ++i) {
      u.segment<3>(3 * i) = random.vector();
      gradient += u.segment<3>(3 * i) * b[i].transpose();
    }
    Eigen::Matrix<double, 12, 1> h = Eigen::Matrix<double, 12, 1>::Zero();
    for (int a = 0; a < 4; ++a)
      for (int i = 0; i < 8; ++i)
        h.segment<3>(3 * a) += hex_modes[3 + a][i] * (u.segment<3>(3 * i) - gradient * rest[i]);
    const Mat3 strain = 0.5 * (gradient + gradient.transpose());
    const double uniform = hex_volume(rest) * (moduli.shear_modulus * strain.squaredNorm() +
                                               0.5 * moduli.lame_lambda * strain.trace() * strain.trace());
    const double whole = 0.5 * u.dot(incompatible_stiffness(rest, moduli) * u);
    EXPECT_NEAR(uniform + 0.5 * h.dot(hourglass_stiffness(rest, moduli) * h), whole, 1e-12 * whole);
  }
}

// An element that is inside out, and one flat as a sheet, among good ones: the rotation is the SVD's, others do not
// notice.
TEST(Kernels, ElementsWithoutARotationDoNotHarmTheOthers) {
  const Tissue tissue = row(11);
  Motion motion = random_motion(tissue, 2, 3);
  const auto turn_inside_out = [&](std::size_t e, double factor) {
    const Vec3 foot = motion.positions[tissue.elements[e][0].index()];
    const Vec3 up = (motion.positions[tissue.elements[e][4].index()] - foot).normalized();
    for (const NodeId node : tissue.elements[e]) {
      Vec3& x = motion.positions[node.index()];
      x += (factor - 1) * up.dot(x - foot) * up;
    }
  };
  turn_inside_out(2, -0.7);
  turn_inside_out(9, 1e-5);
  for (const Kernels kernels : available_kernels()) {
    SCOPED_TRACE(name(kernels));
    const Corotational law(tissue, in_elements(tissue, moduli), 0, kernels);
    const DenseCorotational reference(tissue, 0);
    expect_same(flat(forces_of(law, motion.step())), flat(forces_of(reference, motion.step())), 1e-10);
  }
}

// Stretched or flattened along one of its edges, far beyond what an embryo's element is: still the same rotation.
TEST(Kernels, ElementsOfAnyStretchHaveTheirRotation) {
  const Tissue tissue = row(11);
  for (const double factor : {0.02, 0.2, 0.6, 2.0, 5.0, 50.0})
    for (int axis = 0; axis < 3; ++axis) {
      Motion motion = random_motion(tissue, 2, 3);
      for (Vec3& x : motion.positions) x[axis] *= factor;
      for (const Kernels kernels : available_kernels()) {
        SCOPED_TRACE(::testing::Message() << name(kernels) << ", times " << factor << " along axis " << axis);
        expect_same_law(Corotational(tissue, in_elements(tissue, moduli), 0, kernels), DenseCorotational(tissue, 0),
                        motion, 1e-10);
      }
    }
}

TEST(Kernels, VolumesAreThoseOfEachElement) {
  for (const Kernels kernels : available_kernels())
    for (const int elements : {1, 8, 11}) {
      SCOPED_TRACE(name(kernels));
      const Tissue tissue = row(elements);
      const Motion motion = random_motion(tissue, 4, 9);
      const CellVolumes volumes(tissue, kernels);
      const std::vector<double> of_cells = volumes.volumes(motion.positions);
      Vectors gradients(8 * static_cast<std::size_t>(elements));
      volumes.gradients(motion.positions, gradients);
      std::vector<double> pressures;
      Vectors forces(tissue.node_count(), Vec3::Zero()), product = forces;
      Vectors expected_forces = forces, expected_product = forces;
      const Vectors direction = Random(6).vectors(tissue.node_count());
      for (int e = 0; e < elements; ++e) {
        const HexPoints points = gather(motion.positions, tissue.elements[e]);
        pressures.push_back(0.1 * e - 0.3);
        EXPECT_NEAR(of_cells[e], hex_volume(points), 1e-13 * of_cells[e]);
        const auto gradient = hex_volume_gradient(points);
        const auto hessian = hex_volume_hessian(points);
        const HexPoints moves = gather(direction, tissue.elements[e]);
        for (int i = 0; i < 8; ++i) {
          EXPECT_LE((gradients[8 * e + i] - gradient[i]).norm(), 1e-13 * 800);
          expected_forces[tissue.elements[e][i].index()] += pressures[e] * gradient[i];
          for (int j = 0; j < 8; ++j)
            expected_product[tissue.elements[e][i].index()] -= pressures[e] * hessian[i][j].cross(moves[j]);
        }
      }
      volumes.add_forces(motion.positions, pressures, forces);
      volumes.add_tangent_product(motion.positions, pressures, direction, product);
      expect_same(flat(forces), flat(expected_forces), 1e-12);
      expect_same(flat(product), flat(expected_product), 1e-12);
    }
}

// All results that are sums over elements, as bits.
std::vector<double> results_with(int threads, const Tissue& tissue, const Motion& motion, Kernels kernels) {
  const ThreadCount scope(threads);
  const Corotational elasticity(tissue, in_elements(tissue, moduli), 1, kernels);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false, kernels);
  const CellVolumes volumes(tissue, kernels);
  const Vectors direction = Random(6).vectors(tissue.node_count());
  std::vector<double> results = volumes.volumes(motion.positions);
  Vectors sums(tissue.node_count(), Vec3::Zero());
  for (const Law* law : {static_cast<const Law*>(&elasticity), static_cast<const Law*>(&dilatation)}) {
    results.push_back(law->energy(motion.step()));
    law->add_forces(motion.step(), sums);
    law->add_tangent_product(motion.step(), direction, sums);
  }
  const std::vector<double> pressures(tissue.cells.size(), 0.2);
  volumes.add_forces(motion.positions, pressures, sums);
  volumes.add_tangent_product(motion.positions, pressures, direction, sums);
  Vectors gradients(8 * tissue.elements.size());
  volumes.gradients(motion.positions, gradients);
  for (const Vec3& g : gradients) results.insert(results.end(), g.begin(), g.end());
  for (const Vec3& sum : sums) results.insert(results.end(), sum.begin(), sum.end());
  return results;
}

TEST(Kernels, ThreadsDoNotChangeABit) {
  // Enough for several windows of chunks, in cells of several elements.
  const Tissue tissue = build_shell({.cells = {18, 9, 8}, .elements_per_cell = {3, 2, 1}});
  const Motion motion = random_motion(tissue, 1, 5);
  for (const Kernels kernels : available_kernels()) {
    const std::vector<double> one = results_with(1, tissue, motion, kernels);
    for (const int threads : {2, 4}) EXPECT_EQ(one, results_with(threads, tissue, motion, kernels)) << name(kernels);
  }
}

TEST(Kernels, AreChosenByTheMachineOrTheEnvironment) {
  const char* kept = std::getenv("PLICA_KERNELS");
  const std::string before = kept ? kept : "";
  setenv("PLICA_KERNELS", "", 1);
  EXPECT_EQ(chosen_kernels(), available_kernels().back());
  setenv("PLICA_KERNELS", "generic", 1);
  EXPECT_EQ(chosen_kernels(), Kernels::generic);
  setenv("PLICA_KERNELS", "abacus", 1);
  EXPECT_THROW((void)chosen_kernels(), std::invalid_argument);
  setenv("PLICA_KERNELS", before.c_str(), 1);
}

/// Elements that have no node in common. The last node of each hangs: on one free node for all of them, or on its own
/// element's first.
Tissue elements_that_hang(int count, bool on_one) {
  Tissue tissue;
  tissue.rest_positions.assign(8 * count, Vec3::Zero());
  for (int e = 0; e < count; ++e) {
    std::array<NodeId, 8> nodes;
    for (int i = 0; i < 7; ++i) nodes[i] = NodeId(7 * e + i);
    nodes[7] = NodeId(7 * count + e);
    tissue.elements.push_back(nodes);
    tissue.hanging.push_back({{on_one ? NodeId(0) : nodes[0], 1.0}});
  }
  return tissue;
}

/// Whether two threads are ever in chunks of these elements at once.
bool overlaps(const Tissue& tissue) {
  const ThreadCount scope(4);
  std::atomic<int> inside = 0;
  std::atomic<bool> overlap = false;
  ElementChunks(tissue, tissue.elements).for_batches([&](std::size_t, std::size_t) {
    if (++inside > 1) overlap = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    --inside;
  });
  return overlap;
}

TEST(ElementChunks, ThoseThatHangOnTheSameNodeAreNotTakenAtOnce) {
  constexpr int worth_sharing = 4096;
  EXPECT_TRUE(overlaps(elements_that_hang(worth_sharing, false)));
  EXPECT_FALSE(overlaps(elements_that_hang(worth_sharing, true)));
}

}  // namespace
