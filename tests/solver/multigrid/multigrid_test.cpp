// Multigrid, and the order of its nodes.
#include "core/threads.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/multigrid/smoother.hpp"
#include "support/cubes.hpp"
#include "support/models.hpp"

namespace {

using Doubles = Eigen::VectorXd;

// A step's matrix: tangents of the laws, some nodes fixed along a direction each.
class System final : public TangentSink {
 public:
  explicit System(const Model& model, double duration_s = 5) : normals(model.tissue.node_count(), Vec3::Zero()) {
    std::vector<int> groups;
    for (const auto& element : model.tissue.elements)
      for (const NodeId node : element) groups.push_back(node.number());
    pattern = pattern_of_groups(static_cast<int>(normals.size()), groups, 8);
    blocks_.assign(pattern.columns.size(), Mat3::Zero());
    const auto& rest = model.tissue.rest_positions;
    const Vectors still(rest.size(), Vec3::Zero());
    const Step step{rest, rest, still, duration_s, duration_s, true};
    for (const auto& law : model.laws) law->add_tangent(step, *this);
    positions_ = rest;
  }

  void add_block(NodeId row, NodeId column, const Mat3& block) override {
    if (column <= row)
      blocks_[pattern.find(row.number(), column.number())] += block;
    else
      blocks_[pattern.find(column.number(), row.number())] += block.transpose();
  }

  /// After `normals`, unit vectors or zero, are as they should be.
  void fix() {
    values.clear();
    near_kernel.clear();
    for (int row = 0; row < pattern.nodes(); ++row) {
      for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at) {
        Mat3 block = without(row) * blocks_[at] * without(pattern.columns[at]);
        if (pattern.columns[at] == row) block += 20 * normals[row] * normals[row].transpose();
        append(block, values);
      }
      Eigen::Matrix<double, 3, 6> motion;
      motion << Mat3::Identity(), cross_matrix(positions_[row] / 100).transpose();
      append(without(row) * motion, near_kernel);
    }
  }

  [[nodiscard]] Doubles operator*(const Doubles& x) const {
    Doubles y = Doubles::Zero(x.size());
    for (int row = 0; row < pattern.nodes(); ++row)
      for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at) {
        const int column = pattern.columns[at];
        const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> block(&values[9 * std::size_t(at)]);
        const Mat3 A = block.cast<double>();
        y.segment<3>(3 * row) += A * x.segment<3>(3 * column);
        if (column != row) y.segment<3>(3 * column) += A.transpose() * x.segment<3>(3 * row);
      }
    return y;
  }

  [[nodiscard]] Doubles noise(unsigned seed) const {
    Random random(seed);
    Doubles x(3 * pattern.nodes());
    for (int n = 0; n < pattern.nodes(); ++n) x.segment<3>(3 * n) = without(n) * random.vector();
    return x;
  }

  BlockPattern pattern;
  std::vector<float> values, near_kernel;
  Vectors normals;

 private:
  [[nodiscard]] Mat3 without(int node) const { return Mat3::Identity() - normals[node] * normals[node].transpose(); }
  template <class M>
  static void append(const M& matrix, std::vector<float>& to) {
    for (int i = 0; i < matrix.rows(); ++i)
      for (int j = 0; j < matrix.cols(); ++j) to.push_back(static_cast<float>(matrix(i, j)));
  }
  std::vector<Mat3> blocks_;
  Vectors positions_;
};

Doubles apply(const Preconditioner& preconditioner, const Doubles& r) {
  std::vector<float> x(r.data(), r.data() + r.size());
  preconditioner.solve(x);
  return Eigen::Map<const Eigen::VectorXf>(x.data(), r.size()).cast<double>();
}

struct Solution {
  Doubles x;
  int iterations = 0;
};

Solution conjugate_gradients(const System& system, const Preconditioner& preconditioner, const Doubles& b,
                             double tolerance) {
  Solution s{Doubles::Zero(b.size())};
  Doubles r = b, last = Doubles::Zero(b.size()), p = Doubles::Zero(b.size());
  for (double rz = 1; r.norm() > tolerance * b.norm() && s.iterations < 300; ++s.iterations) {
    const Doubles z = apply(preconditioner, r);
    const double beta = s.iterations == 0 ? 0 : z.dot(r - last) / rz;
    rz = z.dot(r);
    p = z + beta * p;
    const Doubles Ap = system * p;
    const double alpha = rz / p.dot(Ap);
    last = r;
    s.x += alpha * p;
    r -= alpha * Ap;
  }
  return s;
}

Model block(std::array<int, 3> cells, double poisson = 0.45) {
  Model model(build_block({.length_um = 20.0 * cells[0],
                           .width_um = 20.0 * cells[1],
                           .cell_height_um = 40,
                           .cells = cells,
                           .elements_per_cell = {1, 1, 1}}));
  add_elasticity(model, poisson);
  add_drag(model);
  return model;
}

// The pill of 18 x 9 x 8 cells, so many times as large in each direction.
Model pill(int scale) {
  Model model(build_shell(
      {.length_um = 460.0 * scale, .diameter_um = 280.0 * scale, .cells = {18 * scale, 9 * scale, 8 * scale}}));
  add_elasticity(model, 0.48);
  add_drag(model);
  model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
  return model;
}

System in_its_shell(const Model& model, double duration_s = 5) {
  System system(model, duration_s);
  for (const NodeId node : model.obstacles.front()->nodes())
    system.normals[node.index()] = model.obstacles.front()->gap(model.tissue.rest_positions[node.index()]).inward;
  system.fix();
  return system;
}

System free_of_shell(const Model& model, double duration_s = 5) {
  System system(model, duration_s);
  system.fix();
  return system;
}

int iterations(const System& system) {
  const auto multigrid = make_multigrid(system.pattern);
  EXPECT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  return conjugate_gradients(system, *multigrid, system.noise(3), 1e-6).iterations;
}

TEST(Multigrid, IsSymmetricAndPositiveDefinite) {
  const Model sheet = pill(2), solid = block({16, 14, 12});
  for (const System& system : {free_of_shell(sheet), in_its_shell(sheet), free_of_shell(solid)}) {
    const auto multigrid = make_multigrid(system.pattern);
    ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
    const Doubles u = system.noise(1), v = system.noise(2);
    const Doubles Bu = apply(*multigrid, u), Bv = apply(*multigrid, v);
    EXPECT_NEAR(u.dot(Bv) / v.dot(Bu), 1, 1e-4);
    EXPECT_GT(u.dot(Bu), 0);
    EXPECT_GT(v.dot(Bv), 0);
  }
}

TEST(Multigrid, FindsAKnownSolution) {
  const Model solid = block({16, 14, 12});
  const System system = free_of_shell(solid, 1000);
  const auto multigrid = make_multigrid(system.pattern);
  ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  const Doubles exact = system.noise(5);
  const Solution found = conjugate_gradients(system, *multigrid, system * exact, 1e-9);
  EXPECT_LT((found.x - exact).norm(), 1e-6 * exact.norm());
  EXPECT_LT(found.iterations, 40);
}

TEST(Multigrid, TakesRigidMotionsToTheCoarseLevelExactly) {
  // Over a step this long next to nothing resists rigid motions, and only the coarsest level can find them again.
  const Model solid = block({16, 14, 12});
  const System system = free_of_shell(solid, 1e4);
  const auto multigrid = make_multigrid(system.pattern);
  ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  for (int motion = 0; motion < 6; ++motion) {
    Doubles v(3 * system.pattern.nodes());
    for (int i = 0; i < v.size(); ++i) v[i] = system.near_kernel[6 * static_cast<std::size_t>(i) + motion];
    EXPECT_LT((apply(*multigrid, system * v) - v).norm(), 0.05 * v.norm()) << "motion " << motion;
  }
}

TEST(Multigrid, IterationsHardlyGrowWithTheSheet) {
  const Model small = pill(2), large = pill(4);
  for (const double duration : {0.05, 5.0, 100.0, 3000.0}) {
    const int few = iterations(in_its_shell(small, duration)), many = iterations(in_its_shell(large, duration));
    EXPECT_LT(few, 15) << duration;
    EXPECT_LE(many, few + 4) << duration;
    EXPECT_LE(iterations(free_of_shell(large, duration)), few + 6) << duration;
  }
}

TEST(Multigrid, IterationsHardlyGrowWithASolid) {
  const int few = iterations(free_of_shell(block({14, 12, 12}))), many = iterations(free_of_shell(block({32, 24, 20})));
  EXPECT_LT(few, 13);
  EXPECT_LE(many, few + 3);
  EXPECT_LT(iterations(free_of_shell(block({14, 12, 12}, 0.49))), 25);
}

TEST(Multigrid, LeavesFixedDirectionsAlone) {
  const Model model = pill(2);
  System system(model);
  Random random(9);
  for (std::size_t n = 0; n < system.normals.size(); n += 2) system.normals[n] = random.vector().normalized();
  system.fix();
  const auto multigrid = make_multigrid(system.pattern);
  ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  const Doubles r = system.noise(4), z = apply(*multigrid, r);
  double along = 0;
  for (std::size_t n = 0; n < system.normals.size(); ++n)
    along = std::max(along, std::abs(system.normals[n].dot(Vec3(z.segment<3>(3 * static_cast<int>(n))))));
  EXPECT_LT(along, 1e-5 * z.lpNorm<Eigen::Infinity>());
  EXPECT_LT(conjugate_gradients(system, *multigrid, r, 1e-6).iterations, 20);
}

TEST(Multigrid, GivesTheSameBitsForAnyThreadsAndHistory) {
  const Model model = pill(2);
  const System system = in_its_shell(model), other = free_of_shell(model, 0.05);
  const Doubles r = system.noise(6);
  std::vector<Doubles> results;
  for (const int count : {1, 2, 4}) {
    const ThreadCount scope(count);
    const auto multigrid = make_multigrid(system.pattern);
    if (count == 4) {
      ASSERT_TRUE(multigrid->factorise(other.values, other.near_kernel));
    }
    ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
    results.push_back(apply(*multigrid, r));
    EXPECT_EQ(apply(*multigrid, r), results.back());
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(Multigrid, IsTheFactorOfASmallMatrix) {
  const Model model = pill(1);
  const System system = in_its_shell(model);
  const auto multigrid = make_multigrid(system.pattern);
  ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  const Doubles x = system.noise(8);
  EXPECT_LT((apply(*multigrid, system * x) - x).norm(), 1e-4 * x.norm());
}

// A matrix of blocks that are multiples of the identity; no rigid motions are near its kernel.
struct Scalar {
  Scalar(int nodes, std::span<const int> pairs, float diagonal, float beside)
      : pattern(pattern_of_groups(nodes, pairs, 2)), values(9 * pattern.columns.size(), 0.0F) {
    for (int row = 0; row < nodes; ++row)
      for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at)
        for (int i = 0; i < 3; ++i)
          values[9 * std::size_t(at) + 4 * i] = pattern.columns[at] == row ? diagonal : beside;
    near_kernel.assign(18 * static_cast<std::size_t>(nodes), 0.0F);
  }
  [[nodiscard]] bool factorise() const { return make_multigrid(pattern)->factorise(values, near_kernel); }
  [[nodiscard]] std::vector<float> solve_ones() const {
    const auto multigrid = make_multigrid(pattern);
    EXPECT_TRUE(multigrid->factorise(values, near_kernel));
    std::vector<float> x(near_kernel.size() / 6, 1.0F);
    multigrid->solve(x);
    return x;
  }
  BlockPattern pattern;
  std::vector<float> values, near_kernel;
};

std::vector<int> chain(int nodes) {
  std::vector<int> pairs;
  for (int n = 0; n + 1 < nodes; ++n) pairs.insert(pairs.end(), {n, n + 1});
  return pairs;
}

TEST(Multigrid, TakesNodesWithoutNeighbours) {
  for (const float x : Scalar(5000, {}, 4, 0).solve_ones()) ASSERT_NEAR(x, 0.25, 0.1);
  for (const float x : Scalar(1, {}, 4, 0).solve_ones()) ASSERT_NEAR(x, 0.25, 1e-6);
  for (const float x : Scalar(5000, chain(3000), 4, -1).solve_ones()) ASSERT_TRUE(x > 0.1 && x < 1) << x;
  EXPECT_TRUE(Scalar(5000, chain(2), 4, -1).factorise());
}

TEST(Multigrid, TakesRigidMotionsThatAreZero) {
  // No motion at all is near the kernel: the coarser levels have nothing to do, and smoothing is left.
  const Scalar scalar(5000, chain(5000), 4, -1);
  for (const float x : scalar.solve_ones()) ASSERT_TRUE(std::isfinite(x) && x > 0);
}

TEST(Multigrid, SaysWhenAMatrixIsNotPositiveDefinite) {
  Scalar scalar(5000, chain(5000), 4, -1);
  EXPECT_TRUE(scalar.factorise());
  auto negative = scalar;
  negative.values[9 * static_cast<std::size_t>(scalar.pattern.find(4000, 4000)) + 4] = -4;
  EXPECT_FALSE(negative.factorise());
  auto not_a_number = scalar;
  not_a_number.values[9 * static_cast<std::size_t>(scalar.pattern.find(4000, 3999))] =
      std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(not_a_number.factorise());
  auto infinite = scalar;
  infinite.values[9 * static_cast<std::size_t>(scalar.pattern.find(70, 70))] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(infinite.factorise());
  EXPECT_FALSE(Scalar(5000, chain(5000), 4, -9).factorise());
}

TEST(Multigrid, RecoversFromAMatrixThatWasNone) {
  const Model model = pill(2);
  const System system = in_its_shell(model);
  const auto multigrid = make_multigrid(system.pattern), fresh = make_multigrid(system.pattern);
  auto broken = system.values;
  for (float& value : broken) value = -value;
  EXPECT_FALSE(multigrid->factorise(broken, system.near_kernel));
  ASSERT_TRUE(multigrid->factorise(system.values, system.near_kernel));
  ASSERT_TRUE(fresh->factorise(system.values, system.near_kernel));
  const Doubles r = system.noise(6);
  EXPECT_EQ(apply(*multigrid, r), apply(*fresh, r));
}

BlockPattern box(int nx, int ny, int nz, const std::vector<int>& names) {
  std::vector<int> groups = cubes_of_box(nx, ny, nz);
  for (int& node : groups) node = names[node];
  return pattern_of_groups(nx * ny * nz, groups, 8);
}

std::vector<int> shuffled(int count) {
  std::vector<int> names(count);
  std::iota(names.begin(), names.end(), 0);
  Random random(3);
  for (int i = count; i-- > 1;) std::swap(names[i], names[static_cast<int>(0.5 * (random.number() + 1) * i)]);
  return names;
}

void expect_bounds(const SparsePattern& rows, const std::vector<int>& bounds) {
  ASSERT_EQ(bounds.front(), 0);
  ASSERT_EQ(bounds.back(), rows.count());
  const auto group_of = [&](int row) { return std::ranges::upper_bound(bounds, row) - bounds.begin() - 1; };
  for (int row = 0; row < rows.count(); ++row)
    for (const int column : rows.of(row)) EXPECT_LE(std::abs(group_of(row) - group_of(column)), 1);
}

TEST(MultigridOrder, NeighboursAreInGroupsBesideEachOtherHoweverNodesAreNumbered) {
  for (const bool shuffle : {false, true}) {
    std::vector<int> names = shuffled(60 * 8 * 3);
    if (!shuffle) std::ranges::sort(names);
    const BlockPattern pattern = box(60, 8, 3, names);
    const std::vector<int> places = multigrid::places_by_distance(pattern);
    std::vector<int> sorted = places;
    std::ranges::sort(sorted);
    for (int k = 0; k < pattern.nodes(); ++k) ASSERT_EQ(sorted[k], k);

    const multigrid::Matrix<3> ordered(pattern, places), as_given(pattern);
    const std::vector<int> bounds = multigrid::groups_of_rows(ordered.rows(), 10);
    expect_bounds(ordered.rows(), bounds);
    EXPECT_GT(bounds.size(), 50U) << "about one for each of the sixty sheets of nodes across the box";
    expect_bounds(as_given.rows(), multigrid::groups_of_rows(as_given.rows(), 10));
  }
}

TEST(MultigridOrder, PiecesAndLoneNodesHavePlacesToo) {
  const BlockPattern pattern = pattern_of_groups(9, std::vector<int>{7, 2, 2, 5, 0, 8}, 2);  // 7-2-5, 0-8, lone ones
  std::vector<int> places = multigrid::places_by_distance(pattern);
  EXPECT_EQ(std::abs(places[7] - places[2]), 1);
  EXPECT_EQ(std::abs(places[5] - places[2]), 1);
  EXPECT_EQ(std::abs(places[0] - places[8]), 1);
  std::ranges::sort(places);
  for (int k = 0; k < 9; ++k) EXPECT_EQ(places[k], k);
  EXPECT_EQ(multigrid::groups_of_rows(multigrid::Matrix<3>(BlockPattern{}).rows(), 10), std::vector<int>{0});
}

// Sweeps that read a neighbour too early or too late would leave another residual than that of x.
TEST(MultigridOrder, SweepsGroupByGroupLeaveTheResidualOfWhatTheyFound) {
  const BlockPattern pattern = box(60, 20, 10, shuffled(60 * 20 * 10));
  Random random(5);
  std::vector<float> values;
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at)
      for (int k = 0; k < 9; ++k)
        values.push_back(pattern.columns[at] != row ? static_cast<float>(random.number()) : k % 4 == 0 ? 100.0F : 0.0F);
  multigrid::Matrix<3> matrix(pattern, multigrid::places_by_distance(pattern));
  ASSERT_TRUE(matrix.set(values));
  EXPECT_GE(multigrid::groups_of_rows(matrix.rows(), 2048).size(), 6U) << "several groups are at work at once";
  multigrid::Smoother<3> smoother(matrix);
  ASSERT_TRUE(smoother.update());

  std::vector<float> b(matrix.unknowns());
  for (float& value : b) value = static_cast<float>(random.number());
  std::vector<float> first;
  for (const int threads : {1, 2, 4}) {
    const ThreadCount scope(threads);
    std::vector<float> r = b, x(b.size()), Ax(b.size());
    smoother.start(r, x);
    matrix.multiply(x, Ax);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      error += std::pow(r[i] - (b[i] - Ax[i]), 2);
      size += b[i] * b[i];
    }
    EXPECT_LT(std::sqrt(error / size), 1e-6);
    if (first.empty()) first = r;
    EXPECT_EQ(r, first) << threads << " threads";
  }
}

}  // namespace
