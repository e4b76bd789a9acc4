#include "support/linear_statics.hpp"

#include <Eigen/Sparse>

#include "mechanics/constraints/cell_volume.hpp"
#include "solver/algebra/linear_solver.hpp"
#include "support/elements.hpp"

namespace plica::support {
namespace {

struct Triplets final : TangentSink {
  explicit Triplets(const Tissue& of) : tissue(of) {
    for (std::size_t n = tissue.free_node_count(); n < tissue.node_count(); ++n)  // which have none of their own
      for (int i = 0; i < 3; ++i) entries.emplace_back(3 * n + i, 3 * n + i, 1);
  }
  void add_block(NodeId row, NodeId column, const Mat3& block) override {
    tissue.for_free_nodes(row, [&](NodeId a, double of_row) {
      tissue.for_free_nodes(column, [&](NodeId b, double of_column) {
        const Mat3 part = of_row * of_column * block;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            entries.emplace_back(3 * a.number() + i, 3 * b.number() + j, part(i, j));
            if (row != column) entries.emplace_back(3 * b.number() + j, 3 * a.number() + i, part(i, j));
          }
      });
    });
  }
  const Tissue& tissue;
  std::vector<Eigen::Triplet<double>> entries;
};

Vectors unflat(const Eigen::VectorXd& u) {
  Vectors result(u.size() / 3);
  for (std::size_t n = 0; n < result.size(); ++n) result[n] = u.segment<3>(3 * static_cast<int>(n));
  return result;
}

}  // namespace

struct LinearStatics::Stiffness {
  Eigen::SparseMatrix<double> matrix;

  Stiffness(int size, const Triplets& triplets) : matrix(size, size) {
    matrix.setFromTriplets(triplets.entries.begin(), triplets.entries.end());
  }
};

LinearStatics::LinearStatics(const Tissue& tissue)
    : tissue_(tissue),
      size_(3 * static_cast<int>(tissue.node_count())),
      prescribed_(size_),
      loads_(Eigen::VectorXd::Zero(size_)) {}

LinearStatics::LinearStatics(const Tissue& tissue, const ElasticModuli& moduli) : LinearStatics(tissue) {
  Triplets triplets(tissue);
  const Motion rest = at_rest(tissue);
  Corotational(tissue, in_elements(tissue, moduli), 0).add_tangent(rest.step(), triplets);
  Dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false).add_tangent(rest.step(), triplets);
  stiffness_ = std::make_unique<Stiffness>(size_, triplets);
}

LinearStatics::~LinearStatics() = default;
LinearStatics::LinearStatics(LinearStatics&& other) noexcept = default;

LinearStatics LinearStatics::of_elements(const Tissue& tissue, const ElasticModuli& moduli) {
  LinearStatics statics(tissue);
  Triplets triplets(tissue);
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const Mat24 K = incompatible_stiffness(tissue.element_rest_shape[e], moduli);
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j <= i; ++j)
        triplets.add_block(tissue.elements[e][i], tissue.elements[e][j], K.block<3, 3>(3 * i, 3 * j));
  }
  statics.stiffness_ = std::make_unique<Stiffness>(statics.size_, triplets);
  return statics;
}

Vectors LinearStatics::solve() const {
  const auto& K = stiffness_->matrix;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(size_);
  for (int i = 0; i < size_; ++i) u[i] = prescribed_[i].value_or(0);
  const Eigen::VectorXd right = loads_ - K * u;
  SparsePattern pattern;
  std::vector<double> values, unknowns(size_, 0.0);
  for (int row = 0; row < size_; ++row) {  // K is symmetric: a row is a column
    for (Eigen::SparseMatrix<double>::InnerIterator k(K, row); k; ++k) {
      const int column = static_cast<int>(k.row());
      if (column > row) continue;
      const bool fixed = prescribed_[row] || prescribed_[column];
      if (fixed && row != column) continue;
      pattern.columns.push_back(column);
      values.push_back(k.value());
    }
    pattern.starts.push_back(static_cast<int>(pattern.columns.size()));
  }
  for (int i = 0; i < size_; ++i)
    if (!prescribed_[i]) unknowns[i] = right[i];
  const auto solver = make_direct_solver();
  solver->analyse(pattern);
  EXPECT_TRUE(solver->factorise(values));
  solver->solve(unknowns);
  for (int i = 0; i < size_; ++i)
    if (!prescribed_[i]) u[i] = unknowns[i];
  // The answer is checked here, so that the linear solver is not taken on trust.
  const Eigen::VectorXd left = K * u - loads_;
  double residual = 0;
  for (int i = 0; i < size_; ++i)
    if (!prescribed_[i]) residual = std::max(residual, std::abs(left[i]));
  EXPECT_LE(residual, 1e-9 * (K.cwiseAbs() * u.cwiseAbs()).maxCoeff());
  Vectors displacements = unflat(u);
  tissue_.place_hanging(displacements);
  return displacements;
}

Vectors LinearStatics::reactions(const Vectors& displacements) const {
  Eigen::VectorXd u(size_);
  for (int n = 0; n < size_ / 3; ++n) u.segment<3>(3 * n) = displacements[n];
  return unflat(stiffness_->matrix * u - loads_);
}

}  // namespace plica::support
