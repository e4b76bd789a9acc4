// A layer of extracellular matrix, such as a basement membrane, bonded to apical or basal faces: an incompressible
// neo-Hookean membrane whose rest shape may relax (docs/theory/matrix.md).
//
// At the 2 x 2 Gauss points of a face, with its metric C and the rest metric B,
//   energy = sum a(t) mu h/2 w (I_1 + 1/I_2 - 3),  I_1 = tr(B^-1 C),  I_2 = det C/det B,
// with program a, shear modulus times thickness mu h, and unstretched area w. B relaxes as C_p of neo-Hookean cells.
#pragma once

#include <Eigen/Dense>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/followed_signal.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/membrane_point.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Parameters of a matrix, as in [matrix.NAME] of the scenario.
struct MatrixRule {
  CellSide side = CellSide::basal;
  double stiffness = 0;             // mu h, nN/um
  double prestretch = 1;            // of the reference faces, in every direction
  double relaxation_s = 0;          // tau; 0: no relaxation
  Program program = {};             // time course of the stiffness; digestion if it falls
  ShapeActivationRule follow = {};  // signal that scales the stiffness
};

/// Matrix law. Cell strengths scale the stiffness. Its rest metrics are memory, independent of rest shapes of cells, so
/// growth stretches it. The semidefinite tangent keeps the relaxed rest metric fixed and omits compressive stress.
class MatrixLayer final : public Law, public LawDerivatives {
 public:
  MatrixLayer(const Tissue& tissue, CellPattern pattern, MatrixRule rule);

  [[nodiscard]] std::string_view name() const override { return "matrix"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<MatrixLayer>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;

  /// Return for each Gauss point: B (11, 22, 12) at the beginning of this step, its unstretched area, and, if it
  /// relaxes, B at the beginning of the previous step; then what FollowedSignal has.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;

  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  /// Cells that keep their faces keep the numbers; elsewhere, each Gauss point takes elastic strain and thickness from
  /// the nearest one of the former cell.
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions& positions) const override;

  [[nodiscard]] std::vector<double> program_points_s() const override { return rule_.program.times_s(); }
  [[nodiscard]] std::vector<double> program_jumps_s() const override { return rule_.program.jumps_s(); }
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }

  [[nodiscard]] std::vector<double> with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                                 double time_s) const override;

  /// NoGradient where cells follow a signal.
  [[nodiscard]] const LawDerivatives& derivatives() const override;
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;
  void add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                             std::span<Vec3> positions, const BeginningGradient& gradient) const override;
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override;
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;

 private:
  using Mat2 = MembranePoint::Mat2;
  using Corners = Eigen::Matrix<double, 3, 4>;
  using Tangents = Eigen::Matrix<double, 3, 2>;  // dx/ds, dx/dt
  struct Place {                                 // a Gauss point
    std::size_t face = 0;
    int point = 0;
  };
  [[nodiscard]] static Corners corners(std::span<const Vec3> vectors, const Facet& face);
  [[nodiscard]] static Tangents tangents(const Corners& x, int point);
  /// Add vectors at corners that belong to `of_tangents`, by the transpose of `tangents`.
  static void add_transposed(const Tangents& of_tangents, int point, Corners& of_corners);
  static void add(const Facet& face, const Corners& of_corners, std::span<Vec3> vectors);

  [[nodiscard]] bool flows() const { return rule_.relaxation_s > 0; }
  [[nodiscard]] std::size_t first_number(const Place& at) const {
    return (flows() ? 7 : 4) * (4 * at.face + static_cast<std::size_t>(at.point));
  }
  [[nodiscard]] double stiffness_of(std::size_t face, const Step& step) const {
    const CellId cell = faces_[face].cell;
    return rule_.stiffness * pattern_.strengths[cell.index()] * rule_.program.at(step.end_time_s) *
           followed_.at(followed(step.internal), cell);
  }
  /// Return the part of an internal state that FollowedSignal has.
  template <class Number>
  [[nodiscard]] std::span<Number> followed(std::span<Number> internal) const {
    return internal.last(followed_.size());
  }
  /// Return a Gauss point with tangents A at the end of a step; `stiffness`: mu h.
  [[nodiscard]] MembranePoint point(const Place& at, const Tangents& A, const Step& step, double stiffness) const;
  /// Return it as tangents see it, and the stress that acts in them.
  [[nodiscard]] std::pair<MembranePoint, Mat2> tangent_point(const Place& at, const Tangents& A, const Step& step,
                                                             double stiffness) const;
  [[nodiscard]] double energy_of(std::size_t face, const Step& step, double stiffness) const;
  [[nodiscard]] Corners forces_of(std::size_t face, const Step& step, double stiffness) const;
  [[nodiscard]] Eigen::Matrix<double, 12, 12> tangent_of(std::size_t face, const Step& step) const;
  /// Return the Gauss point of faces first to last - 1 that is nearest to a place.
  [[nodiscard]] Place nearest(std::size_t first, std::size_t last, const Vec3& place,
                              std::span<const Vec3> positions) const;
  void carry(const double* from, const Mat2& map, double* to) const;
  void add_gradient_of_before(const Place& at, const Mat2& gradient, double ahead, std::span<double> internal) const;

  MatrixRule rule_;
  CellPattern pattern_;
  FollowedSignal followed_;
  std::vector<Facet> faces_;
  ElementChunks chunks_;
};

}  // namespace plica
