#include "support/law_checks.hpp"

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/energy.hpp"

namespace plica::support {
namespace {

Eigen::Index size_of(const Step& step) { return 3 * static_cast<Eigen::Index>(step.positions.size()); }

// The work of a law's forces on a straight way of length `size` that takes `size` seconds, by the forces midway, and
// what the law says of it. Midway, what flows has flown for half of the time.
struct Work {
  double of_forces, told;
};

Work work_over(const Law& law, const Tissue& tissue, double size) {
  Model model(tissue);
  model.laws.push_back(law.clone());
  State before = rest_state(model);
  before.time_s = 1;
  Random random(5);
  for (Vec3& x : before.positions) x += random.vector(1.5);
  State after = before;
  after.time_s += size;
  for (Vec3& x : after.positions) x += size * random.vector(2);

  Vectors middle = before.positions;
  for (std::size_t n = 0; n < middle.size(); ++n) middle[n] = 0.5 * (before.positions[n] + after.positions[n]);
  Step step;
  step.positions = middle;
  step.previous_positions = before.positions;
  step.previous_velocities = before.velocities;
  step.rate_s = 0.5 * size;
  step.end_time_s = 1 + 0.5 * size;
  step.internal = before.internals.front();
  if (step.internal.empty()) {
    // Rates are the mean ones of the whole way: (q - q_before)/rate with so large an `ahead` that the way from the
    // beginning to the end is all that counts.
    step.earlier_positions = after.positions;
    step.ahead = 1e6;
    step.rate_s = (0.5 + step.ahead) * size;
  }
  const Vectors forces = forces_of(law, step);
  double work = 0;
  for (std::size_t n = 0; n < forces.size(); ++n) work += forces[n].dot(after.positions[n] - before.positions[n]);

  step.positions = after.positions;
  step.ahead = 0;
  step.rate_s = size;
  step.end_time_s = after.time_s;
  after.internals.front() = law.next_internal(step);
  const EnergyFlow flow = energy_flows(model, before, after).front();
  return {work, flow.active - flow.stored - flow.dissipated};
}

}  // namespace

bool has_derivatives(const Law& law) {
  try {
    (void)law.derivatives();
    return true;
  } catch (const NoGradient& refusal) {
    EXPECT_TRUE(std::string(refusal.what()).starts_with(law.label() + ": ")) << refusal.what();
    return false;
  }
}

DenseTangent::DenseTangent(const Law& law, const Step& step)
    : matrix(Eigen::MatrixXd::Zero(size_of(step), size_of(step))) {
  law.add_tangent(step, *this);
}

void DenseTangent::add_block(NodeId row, NodeId column, const Mat3& block) {
  matrix.block<3, 3>(3 * row.number(), 3 * column.number()) += block;
  if (row != column) matrix.block<3, 3>(3 * column.number(), 3 * row.number()) += block.transpose();
}

Eigen::VectorXd flat(const Vectors& vectors) {
  Eigen::VectorXd result(3 * static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t n = 0; n < vectors.size(); ++n) result.segment<3>(3 * static_cast<Eigen::Index>(n)) = vectors[n];
  return result;
}

Eigen::VectorXd product_of(const Law& law, const Step& step, const Vectors& direction) {
  Vectors product(step.positions.size(), Vec3::Zero());
  law.add_tangent_product(step, direction, product);
  return flat(product);
}

void expect_forces_are_minus_energy_gradient(const Law& law, Motion motion, double tolerance) {
  const Vectors forces = forces_of(law, motion.step());
  const double scale = std::max(largest(forces), 1e-3);
  for (std::size_t n = 0; n < motion.positions.size(); ++n)
    for (int axis = 0; axis < 3; ++axis) {
      double& x = motion.positions[n][axis];
      const double kept = x;
      x = kept + difference_um;
      const double above = law.energy(motion.step());
      x = kept - difference_um;
      const double below = law.energy(motion.step());
      x = kept;
      EXPECT_NEAR(forces[n][axis], -(above - below) / (2 * difference_um), tolerance * scale)
          << law.name() << ", node " << n << ", axis " << axis;
    }
}

void expect_tangent_is_minus_force_gradient(const Law& law, Motion motion, double tolerance) {
  const Eigen::MatrixXd tangent = DenseTangent(law, motion.step()).matrix;
  Eigen::MatrixXd differences(tangent.rows(), tangent.cols());
  for (Eigen::Index i = 0; i < tangent.cols(); ++i) {
    double& x = motion.positions[static_cast<std::size_t>(i / 3)][i % 3];
    const double kept = x;
    x = kept + difference_um;
    const Eigen::VectorXd above = flat(forces_of(law, motion.step()));
    x = kept - difference_um;
    const Eigen::VectorXd below = flat(forces_of(law, motion.step()));
    x = kept;
    differences.col(i) = -(above - below) / (2 * difference_um);
  }
  const double scale = std::max(tangent.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LE((tangent - differences).cwiseAbs().maxCoeff(), tolerance * scale) << law.name();
}

void expect_assembled_is_matrix_free(const Law& law, const Motion& motion, unsigned seed) {
  const Eigen::MatrixXd tangent = DenseTangent(law, motion.step()).matrix;
  const double scale = std::max(tangent.cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LE((tangent - tangent.transpose()).cwiseAbs().maxCoeff(), 1e-12 * scale) << law.name() << ": not symmetric";
  Random random(seed);
  for (int k = 0; k < 4; ++k) {
    const Vectors direction = random.vectors(motion.positions.size());
    const Eigen::VectorXd assembled = tangent * flat(direction), free = product_of(law, motion.step(), direction);
    EXPECT_LE((assembled - free).cwiseAbs().maxCoeff(), 1e-12 * scale * static_cast<double>(tangent.rows()))
        << law.name();
  }
}

void check_derivatives(const Law& law, const Tissue& tissue, double size_um, int cases, double tolerance) {
  for (int seed = 1; seed <= cases; ++seed) {
    SCOPED_TRACE(::testing::Message() << "random motion " << seed << " of " << cases);
    Motion motion = random_motion(tissue, size_um, static_cast<unsigned>(seed));
    motion.internal = law.first_internal(tissue);
    expect_forces_are_minus_energy_gradient(law, motion, tolerance);
    expect_tangent_is_minus_force_gradient(law, motion, tolerance);
    expect_assembled_is_matrix_free(law, motion, static_cast<unsigned>(100 + seed));
  }
  ::testing::Test::RecordProperty("random_motions", cases);
  if (has_derivatives(law)) check_law_derivatives(law, tissue, size_um, law.first_internal(tissue), tolerance);
}

void check_law_derivatives(const Law& law, const Tissue& tissue, double size_um, const std::vector<double>& internal,
                           double tolerance, bool with_memory) {
  const LawDerivatives& derivatives = law.derivatives();
  const std::size_t nodes = tissue.node_count();
  for (const unsigned seed : {2U, 3U}) {  // of both orders
    Motion motion = random_motion(tissue, size_um, seed);
    motion.internal = internal;
    Random random(seed);
    const Vectors adjoint = random.vectors(nodes);
    const auto along = [&](const Law& of, const Motion& m) { return flat(adjoint).dot(flat(forces_of(of, m.step()))); };
    Vectors previous(nodes, Vec3::Zero()), earlier = previous, positions = previous;
    std::vector<double> by_internal(internal.size(), 0.0), of_next(internal.size());
    const auto cleared = [&] {
      for (Vectors* vectors : {&previous, &earlier, &positions}) vectors->assign(nodes, Vec3::Zero());
      by_internal.assign(internal.size(), 0.0);
      return BeginningGradient{motion.ahead, previous, earlier, by_internal};
    };
    // A change of everything: of positions by vectors, of numbers by numbers.
    const Vectors d_previous = random.vectors(nodes), d_earlier = random.vectors(nodes), d_end = random.vectors(nodes);
    std::vector<double> d_internal(internal.size());
    for (std::size_t i = 0; i < internal.size(); ++i) d_internal[i] = internal[i] == -1 ? 0 : random.number(0.1);
    for (double& of : of_next) of = random.number();
    const auto changed = [&](double by, bool with_end) {
      Motion m = motion;
      for (std::size_t n = 0; n < nodes; ++n) {
        m.previous_positions[n] += by * d_previous[n];
        if (!m.earlier_positions.empty()) m.earlier_positions[n] += by * d_earlier[n];
        if (with_end) m.positions[n] += by * d_end[n];
      }
      for (std::size_t i = 0; i < internal.size(); ++i) m.internal[i] += by * d_internal[i];
      return m;
    };
    const auto difference = [](const auto& value) {
      return (value(difference_um) - value(-difference_um)) / (2 * difference_um);
    };
    const auto along_change = [&] {
      double sum = flat(previous).dot(flat(d_previous)) + flat(positions).dot(flat(d_end));
      if (motion.ahead > 0) sum += flat(earlier).dot(flat(d_earlier));
      for (std::size_t i = 0; i < internal.size(); ++i) sum += by_internal[i] * d_internal[i];
      return sum;
    };

    const double of_forces = difference([&](double by) { return along(law, changed(by, false)); });
    const double scale = std::max({1e-3, largest(forces_of(law, motion.step())), std::abs(of_forces)});
    derivatives.add_force_gradient(motion.step(), adjoint, cleared());
    EXPECT_NEAR(along_change(), of_forces, tolerance * scale) << law.name() << ", seed " << seed;
    if (with_memory) {
      const BeginningGradient gradient = cleared();
      const std::vector<double> next_internal = law.next_internal(motion.step());
      const std::vector<double> like = derivatives.next_internal_like(law, motion.step(), next_internal);
      EXPECT_TRUE(like.empty() || like == next_internal) << law.name();
      derivatives.add_internal_gradient(motion.step(), next_internal, of_next, positions, gradient);
      const auto next = [&](double by) {
        const Motion m = changed(by, true);
        const std::vector<double> numbers = law.next_internal(m.step());
        return std::inner_product(numbers.begin(), numbers.end(), of_next.begin(), 0.0);
      };
      const double by_difference = difference(next);
      EXPECT_NEAR(along_change(), by_difference, tolerance * std::max(1.0, std::abs(by_difference)))
          << law.name() << ", seed " << seed;
    }

    const std::size_t cells = tissue.cells.size();
    const std::vector<double> ones(cells, 1.0);
    if (law.pattern() && law.pattern()->cells.empty()) continue;
    if (!derivatives.with_strengths(ones)) continue;
    std::vector<double> of_cells(cells, 0.0);
    derivatives.add_strength_gradient(motion.step(), adjoint, of_cells);
    for (std::size_t c = 0; c < cells; c += 1 + cells / 20) {
      const auto with_factor = [&](double by) {
        std::vector<double> factors = ones;
        factors[c] += by;
        return along(*with_strengths(law, factors), motion);
      };
      EXPECT_NEAR(of_cells[c], difference(with_factor), tolerance * scale) << law.name() << ", cell " << c;
    }
  }
}

void check_semidefinite_tangent(const Law& law, const Tissue& tissue, double size_um, bool exact_is_indefinite,
                                int cases) {
  double worst = 0, exact_worst = 0;  // least eigenvalue over the largest
  for (int seed = 1; seed <= cases; ++seed) {
    Motion motion = random_motion(tissue, size_um, static_cast<unsigned>(seed));
    motion.internal = law.first_internal(tissue);
    const auto least_over_largest = [&] {
      const Eigen::MatrixXd tangent = DenseTangent(law, motion.step()).matrix;
      const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(tangent).eigenvalues();
      return values.minCoeff() / values.cwiseAbs().maxCoeff();
    };
    exact_worst = std::min(exact_worst, least_over_largest());
    const Vectors forces = forces_of(law, motion.step());
    motion.semidefinite_tangent = true;
    EXPECT_EQ(forces, forces_of(law, motion.step()));
    expect_assembled_is_matrix_free(law, motion, static_cast<unsigned>(100 + seed));
    worst = std::min(worst, least_over_largest());
  }
  std::printf("%s: least eigenvalue of the tangent over the largest %.1e exact, %.1e semidefinite, in %d motions\n",
              std::string(law.name()).c_str(), exact_worst, worst, cases);
  EXPECT_GE(worst, -1e-12) << law.name();
  EXPECT_EQ(exact_worst < -1e-6, exact_is_indefinite) << law.name();
}

void check_energy_flow(const Law& law, const Tissue& tissue) {
  const Work coarse = work_over(law, tissue, 0.1), fine = work_over(law, tissue, 0.05);
  const double error = coarse.told - coarse.of_forces, finer = fine.told - fine.of_forces;
  EXPECT_GT(std::abs(coarse.of_forces), 1e-3) << law.name();
  EXPECT_LE(std::abs(error), 0.05 * std::abs(coarse.of_forces)) << law.name();
  EXPECT_LE(std::abs(finer), std::abs(error) / 6 + 1e-12 * std::abs(fine.of_forces)) << law.name();
}

Vec3 resultant(const Vectors& forces) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : forces) sum += f;
  return sum;
}
Vec3 torque(const Vectors& forces, std::span<const Vec3> positions) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < forces.size(); ++n) sum += positions[n].cross(forces[n]);
  return sum;
}

void expect_no_resultant_and_no_torque(const Law& law, const Tissue& tissue, double size_um) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Motion motion = random_motion(tissue, size_um, seed);
    const Vectors forces = forces_of(law, motion.step());
    EXPECT_LE(resultant(forces).norm(), 1e-11 * largest(forces));
    EXPECT_LE(torque(forces, motion.positions).norm(), 1e-9 * largest(forces));  // lever arms of up to 100 um
  }
}

}  // namespace plica::support
