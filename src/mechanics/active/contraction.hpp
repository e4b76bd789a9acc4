// Active contraction: Kelvin-Voigt springs along the edges of contractile cells (docs/theory/contraction.md).
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/followed_signal.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/law.hpp"
#include "tissue/polygon_cell.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Spring: a chain of nodes of total length l. Tension a(t) (k max(0, l - U) + P) + c dl/dt, nN.
struct Spring {
  std::vector<NodeId> nodes;
  double stiffness = 0;    // k, nN/um
  double preload = 0;      // P, nN
  double damping = 0;      // c, nN s/um
  double rest_length = 0;  // U, um
  double delay_s = 0;      // delay of its program
  CellId cell = {};        // owner

  static auto parts(auto& spring) {
    return std::tie(spring.nodes, spring.stiffness, spring.preload, spring.damping, spring.rest_length, spring.delay_s,
                    spring.cell);
  }
};

/// Parameters of the springs. Lengths and stiffness as in [contraction.NAME] of the scenario.
struct ContractionRule {
  CellSide side = CellSide::apical;
  double stiffness = 0;                  // nN/um
  double along_ratio = 1;                // factor on stiffness and preload of edges along the axis
  double across_ratio = 1;               // and across it; lateral edges have neither
  bool diagonals = false;                // also both diagonals of the face, with the mean of both factors
  double rest_length_ratio = 0;          // U / reference length
  double preload = 0;                    // nN
  double damping = 0;                    // nN s/um
  double tension = 0;                    // face tension, nN/um, carried by its lines over its width
  std::optional<OtherSide> border = {};  // a cable: only along the border of the active cells with these
};

/// Make the springs of the active cells. Two cells that share an edge have a spring each. In a cell of several
/// elements the tension of its edges is spread over the lines of its face, and each element edge of a line is a spring
/// (docs/decisions/0005-spread-springs.md). The strength of a cell scales k and P; its delay is that of its springs. A
/// face tension is divided among the lines of a direction, which together carry it times the width of the face in the
/// reference state (lateral faces: times the cell perimeter), so it does not depend on cell size.
std::vector<Spring> contraction_springs(const Tissue& tissue, const CellPattern& pattern, const ContractionRule& rule);

/// Contraction law. Its semidefinite tangent omits the rotation of springs under compression.
class Contraction final : public Law, public LawDerivatives {
 public:
  /// Take ownership of the springs. `pattern` serves pulses, ablations and activity_of; springs carry their own
  /// delays. `followed`: signal that scales activities.
  Contraction(std::vector<Spring> springs, Program program, CellPattern pattern = {}, FollowedSignal followed = {});

  [[nodiscard]] std::string_view name() const override { return "contraction"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Contraction>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const override { return groups_; }
  /// NoGradient where cells follow a signal.
  [[nodiscard]] const LawDerivatives& derivatives() const override;
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override;
  /// Dampers have no strengths.
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;
  /// Split each cut edge into two springs in series, with k scaled to keep the tension; edges of the new facet have
  /// none. Diagonals stay whole.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  /// Springs depend on positions at each division.
  [[nodiscard]] std::vector<double> past() const override { return as_numbers(springs_); }
  [[nodiscard]] std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange& change, std::span<const Vec3>,
                                              std::span<const double> past) const override;

  /// Return what FollowedSignal has; then overridden activities, if any.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions&) const override;
  [[nodiscard]] std::vector<double> with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                                 double time_s) const override;

  [[nodiscard]] const Program& program() const { return program_; }
  /// Return the time at which the last spring reaches the end of the program, s.
  [[nodiscard]] double last_program_point_s() const { return program_.delayed_points_s(delays_s()).back(); }
  [[nodiscard]] bool is_active() const override { return true; }
  [[nodiscard]] std::optional<double> activity_of(CellId cell, double time_s,
                                                  std::span<const double> internal) const override;
  [[nodiscard]] std::vector<double> with_activities(std::span<const double> internal,
                                                    std::span<const double> activities) const override {
    return given(internal).put(internal, activities);
  }
  [[nodiscard]] std::vector<double> program_points_s() const override {
    return pattern_.with_ablation_points(program_.delayed_points_s(delays_s()));
  }
  [[nodiscard]] std::vector<double> program_jumps_s() const override {
    return pattern_.with_ablation_jumps(program_.delayed_jumps_s(delays_s()));
  }
  [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }

 private:
  struct Pulled;  // spring at given positions
  // Activity of a delayed spring of this cell, by program or override, including pulses and ablations. `following`: by
  // its signal.
  [[nodiscard]] double activity(CellId cell, double delay_s, double time_s, std::span<const double> internal,
                                double following) const;
  [[nodiscard]] double activity(const Spring& spring, const Step& step) const;
  // Return the parts of an internal state.
  template <class Number>
  [[nodiscard]] std::span<Number> followed(std::span<Number> internal) const {
    return internal.first(followed_.size());
  }
  [[nodiscard]] GivenActivities given(std::span<const double> internal) const {
    return GivenActivities(internal.subspan(std::min(internal.size(), followed_.size())));
  }
  template <class Take>
  void for_springs(const Step& step, const Take& take) const;
  [[nodiscard]] std::vector<double> delays_s() const;

  std::vector<Spring> springs_;
  NodeGroups groups_;        // nodes of all springs, read by the loops
  std::size_t longest_ = 0;  // nodes of the longest chain
  Program program_;
  CellPattern pattern_;
  FollowedSignal followed_;
};

}  // namespace plica
