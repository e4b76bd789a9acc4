// An elastic, viscous foundation under faces of cells: springs and drag per area of the reference faces
// (docs/theory/foundation.md).
//
// A node with reference area A, normal n and displacement d from its anchor has the energy
//   A (a(t) k/2 |P d|^2 + c/(2h) |P m|^2),
// with program a, stiffness k and drag c per area, and m its movement in the step h. P is 1, or n n^T; a one-sided
// spring acts only while d.n > 0, into the foundation.
#pragma once

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/followed_signal.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/derivatives.hpp"

namespace plica {

/// Parameters of a foundation, as in [foundation.NAME] of the scenario.
struct FoundationRule {
  enum class Resists { all, normal, one_sided };
  CellSide side = CellSide::basal;
  double stiffness = 0;  // k, nN/um^3
  double drag = 0;       // c, nN s/um^3; along the normal if one-sided, in both directions
  Resists resists = Resists::all;
  Program program = {};             // time course of k
  ShapeActivationRule follow = {};  // signal that scales k
};

/// Foundation law. Cell strengths scale stiffness and drag. It owns its anchors: after a change of the tissue, new
/// nodes are anchored at the mean of those that they lie between. Once cells have been remeshed, anchors of a face tell
/// neither its area nor its normal: nodes keep their normal, faces their area; those of a cell that is remeshed, or
/// divides, share that of the cell.
class Foundation final : public SignalLaw, public LawDerivatives {
 public:
  Foundation(const Tissue& tissue, CellPattern pattern, FoundationRule rule);

  [[nodiscard]] std::string_view name() const override { return "foundation"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Foundation>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;

  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  /// Anchors of all nodes; once cells have been remeshed, also their normals, and areas of all faces of the side.
  [[nodiscard]] std::vector<double> past() const override;
  [[nodiscard]] std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3> positions,
                                              std::span<const double> past) const override;

  [[nodiscard]] std::vector<double> program_points_s() const override { return rule_.program.times_s(); }
  [[nodiscard]] std::vector<double> program_jumps_s() const override { return rule_.program.jumps_s(); }
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }
  /// NoGradient where cells follow a signal.
  [[nodiscard]] const LawDerivatives& derivatives() const override;
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;

 private:
  struct Support {  // of a node
    std::size_t node = 0;
    double area = 0;                               // um^2, times strengths
    Vec3 normal;                                   // out of the tissue
    std::vector<std::pair<CellId, double>> parts;  // of the area, by cell, if they follow a signal
  };
  void measure(const Tissue& tissue);
  void inherit_faces(const Foundation& before, const TissueChange& change, std::span<const Vec3> positions);
  void support(const Tissue& tissue);
  [[nodiscard]] bool is_pressed(const Support& support, const Step& step) const;
  using Activity = double (FollowedSignal::*)(std::span<const double>, CellId) const;
  /// Return the area of a support times the activity of its cells, in this step or the step before.
  [[nodiscard]] double active_area(const Support& support, std::span<const double> internal,
                                   Activity activity = &FollowedSignal::at) const;
  [[nodiscard]] double spring(const Support& support, const Step& step) const {
    return active_area(support, step.internal) * rule_.stiffness * rule_.program.at(step.end_time_s);
  }
  [[nodiscard]] double damper(const Support& support, const Step& step) const {
    return support.area * rule_.drag / step.rate_s;
  }
  [[nodiscard]] Vec3 resisted(const Support& support, const Vec3& d) const;
  [[nodiscard]] Vec3 displacement(const Support& support, const Step& step) const;
  [[nodiscard]] Vec3 movement(const Support& support, const Step& step) const;
  template <class AreaOf>
  [[nodiscard]] double stored(const Step& step, double activity, const AreaOf& area_of) const;

  FoundationRule rule_;
  CellPattern pattern_;
  Vectors anchors_;            // nodes; um
  Vectors normals_;            // nodes of the side; out of the tissue
  std::vector<Facet> facets_;  // of the side
  std::vector<double> areas_;  // facets; um^2
  bool is_remeshed_ = false;
  std::vector<Support> supports_;
};

}  // namespace plica
