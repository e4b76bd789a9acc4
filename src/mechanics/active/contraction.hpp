// Active contraction: Kelvin-Voigt springs along the edges of contractile cells (docs/theory/contraction.md).
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// One spring: a chain of nodes of total length l. Tension a(t) (k max(0, l - U) + P) + c dl/dt, nN.
struct Spring {
  std::vector<NodeId> nodes;
  double stiffness = 0;    // k, nN/um
  double preload = 0;      // P, nN
  double damping = 0;      // c, nN s/um
  double rest_length = 0;  // U, um
  double delay_s = 0;      // its program starts that much later
  CellId cell = {};        // whose spring it is
};

/// What a contraction asks of each edge. Lengths and stiffness as in the scenario's [contraction.NAME].
struct ContractionRule {
  CellSide side = CellSide::apical;
  double stiffness = 0;          // nN/um
  double along_ratio = 1;        // factor on stiffness and preload of edges along the axis
  double across_ratio = 1;       // and across it; lateral edges have neither
  bool diagonals = false;        // also the two diagonals of the face, with the mean of both factors
  double rest_length_ratio = 0;  // U over the length at rest
  double preload = 0;            // nN
  double damping = 0;            // nN s/um
  double tension = 0;            // of the face, nN/um: what its lines carry together over its width
};

/// The springs of the cells that act. Two that share an edge have a spring each. In a cell of several elements the
/// tension of its edges is spread over the lines of its face, and each element edge of a line is a spring
/// (docs/decisions/0005-spread-springs.md). A cell's strength scales k and P, its delay is its springs'.
/// A tension of the face is divided among its lines of a direction, which together carry it times the face's width at
/// rest (of lateral faces: times the cell's perimeter), so it does not depend on the size of cells.
std::vector<Spring> contraction_springs(const Tissue& tissue, const CellPattern& pattern, const ContractionRule& rule);

/// Its semidefinite tangent leaves out the turning of springs that push.
class Contraction final : public Law {
 public:
  /// `pattern`: for pulses, ablations and activity_of, the springs carry their own delays.
  Contraction(std::vector<Spring> springs, Program program, CellPattern pattern = {});

  [[nodiscard]] std::string_view name() const override { return "contraction"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Contraction>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  /// An edge that is cut becomes two springs in series, k scaled so that their tension is the same; edges of the new
  /// facet have none. A diagonal stays whole.
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_division(std::span<const double> internal, const Tissue& tissue,
                                                            const Division& division) const override;

  [[nodiscard]] const Program& program() const { return program_; }
  /// The program's activity at a time for springs with a delay: that `delay_s` earlier, 0 before the program's time 0.
  [[nodiscard]] double activity(double delay_s, double time_s) const;
  /// When the last spring comes to the program's end.
  [[nodiscard]] double last_program_point_s() const { return program_.delayed_points_s(delays_s()).back(); }
  [[nodiscard]] bool is_active() const override { return true; }
  [[nodiscard]] std::optional<double> activity_of(CellId cell, double time_s,
                                                  std::span<const double> internal) const override;
  [[nodiscard]] std::vector<double> with_activities(std::span<const double> internal,
                                                    std::span<const double> activities) const override;
  [[nodiscard]] std::vector<double> program_points_s() const override;
  [[nodiscard]] std::vector<double> program_jumps_s() const override;
  [[nodiscard]] const std::vector<Spring>& springs() const { return springs_; }
  [[nodiscard]] const CellPattern& pattern() const { return pattern_; }

 private:
  struct Pulled;  // a spring at given positions
  // Of a spring of this cell that starts after a delay: by its program or as told from outside, pulses and ablations
  // included.
  [[nodiscard]] double activity(CellId cell, double delay_s, double time_s, std::span<const double> internal) const;
  [[nodiscard]] double activity(const Spring& spring, const Step& step) const;
  template <class Take>
  void for_springs(const Step& step, const Take& take) const;
  [[nodiscard]] std::vector<double> delays_s() const;

  std::vector<Spring> springs_;
  std::vector<NodeId> nodes_;       // of all springs, one after the other: what the loops read
  std::vector<std::size_t> start_;  // springs + 1, in nodes_
  std::size_t longest_ = 0;         // nodes of the longest chain
  Program program_;
  CellPattern pattern_;
};

}  // namespace plica
