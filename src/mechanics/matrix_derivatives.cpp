// Derivatives of the matrix for gradients of runs. Forces are -A S at Gauss points, so adjoint . forces is -S : E with
// E = A^T V, V the tangents of the adjoint.
#include "mechanics/matrix.hpp"

namespace plica {
namespace {

using Mat2 = MembranePoint::Mat2;

Mat2 symmetric_part(const Mat2& m) { return 0.5 * (m + m.transpose()); }

// Numbers 11, 22, 12: the gradient by the last one has both of a matrix.
void add_gradient(const Mat2& gradient, double factor, double* numbers) {
  numbers[0] += factor * gradient(0, 0);
  numbers[1] += factor * gradient(1, 1);
  numbers[2] += factor * 2 * gradient(0, 1);
}

}  // namespace

void MatrixLayer::add_gradient_of_before(const Place& at, const Mat2& gradient, double ahead,
                                         std::span<double> internal) const {
  double* numbers = &internal[first_number(at)];
  add_gradient(gradient, flows() ? 1 + ahead : 1, numbers);
  if (flows()) add_gradient(gradient, -ahead, numbers + 4);
}

void MatrixLayer::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                     const BeginningGradient& gradient) const {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Corners x = corners(step.positions, faces_[f]), v = corners(adjoint, faces_[f]);
    for (int g = 0; g < 4; ++g) {
      const Tangents A = tangents(x, g);
      const MembranePoint of = point({f, g}, A, step, stiffness_of(f, step));
      const Mat2 E = symmetric_part(A.transpose() * tangents(v, g));
      add_gradient_of_before({f, g}, -of.stress_gradient(E), step.ahead, gradient.internal);
      const std::size_t area = first_number({f, g}) + 3;
      gradient.internal[area] -= of.stress().cwiseProduct(E).sum() / step.internal[area];
    }
  }
}

void MatrixLayer::add_internal_gradient(const Step& step, std::span<const double> /*next*/,
                                        std::span<const double> adjoint, std::span<Vec3> positions,
                                        const BeginningGradient& gradient) const {
  if (!flows()) {
    for (std::size_t i = 0; i < adjoint.size(); ++i) gradient.internal[i] += adjoint[i];
    return;
  }
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Corners x = corners(step.positions, faces_[f]);
    Corners of_corners = Corners::Zero();
    for (int g = 0; g < 4; ++g) {
      const Tangents A = tangents(x, g);
      const std::size_t first = first_number({f, g});
      const double* q = &adjoint[first];
      Mat2 Q;
      Q << q[0], q[2] / 2, q[2] / 2, q[1];
      const auto [of_before, of_metric] = point({f, g}, A, step, 1).rest_gradients(Q);
      add_gradient_of_before({f, g}, of_before, step.ahead, gradient.internal);
      add_transposed(2 * A * of_metric, g, of_corners);
      for (std::size_t k = 0; k < 3; ++k) gradient.internal[first + k] += q[4 + k];  // kept as that of the step before
      gradient.internal[first + 3] += q[3];
    }
    add(faces_[f], of_corners, positions);
  }
}

void MatrixLayer::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                                        std::span<double> of_cells) const {
  for (std::size_t f = 0; f < faces_.size(); ++f)
    of_cells[faces_[f].cell.index()] +=
        forces_of(f, step, stiffness_of(f, step)).cwiseProduct(corners(adjoint, faces_[f])).sum();
}

std::unique_ptr<Law> MatrixLayer::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<MatrixLayer>(*this);
  for (std::size_t c = 0; c < factors.size(); ++c) law->pattern_.strengths[c] *= factors[c];
  return law;
}

}  // namespace plica
