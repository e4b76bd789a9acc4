// The cortex: a thin, active, elastic layer on apical, basal or lateral faces of cells (docs/theory/cortex.md).
//
// The tension T of a face, nN/um, is isotropic and depends on its area A only, unless it has fibres:
//   T = a(t) gamma A/(A + A_s) + b(t) k (A/A_0 - 1) - c (A_r/A)^2,
// with programs a and b, reference area A_r, A_s = saturation A_r, and stress-free area A_0, which is A_r or relaxes
// towards the area: dA_0/dt = (A - A_0)/tau. Where A < A_0, k is `compression_ratio` times smaller. With fibres, all
// this holds for another measure A of the face, which their stretch increases more than the stretch across them.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/fibres.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/active/shape_activation.hpp"
#include "mechanics/active/wall_factors.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/kernels/batch_law.hpp"
#include "tissue/faces.hpp"

namespace plica {

/// Parameters of a cortex, as in [cortex.NAME] of the scenario.
struct CortexRule {
  CellSide side = CellSide::apical;
  double tension = 0;                   // gamma, nN/um
  double saturation = 0;                // A_s / A_r
  double stiffness = 0;                 // k, nN/um
  double compression_ratio = 1;         // stiffness in compression / in extension; 0: slack
  double crowding = 0;                  // c, nN/um
  double relaxation_s = 0;              // tau; 0: no relaxation
  Program program = {};                 // time course of gamma; starts after the delay of the cell
  Program stiffness_program = {};       // time course of k
  ShapeActivationRule activation = {};  // shape-dependent start of both programs, or factor on the tension
  WallFactorRule walls = {};            // of lateral faces: factors on gamma
  FibreRule fibres = {};                // of apical and basal faces

  static auto parts_by_cell(auto& rule) { return std::tie(rule.fibres); }
};

/// Cortex law. Cell strengths scale all terms. A lateral face is shared by two cells and takes the mean of their
/// parameters (0 for an inactive cell); at a boundary it takes those of its one cell; on a mirror plane or at the end
/// of a slice, half of them. The semidefinite tangent omits faces under compression and changes of shape within a face.
class Cortex final : public BatchLaw<Cortex, 4>, public LawDerivatives {
 public:
  Cortex(const Tissue& tissue, CellPattern pattern, CortexRule rule, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "cortex"; }
  [[nodiscard]] const Cortex* cortex() const override { return this; }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;

  /// Return, if areas relax, stress-free / reference areas at the beginning of this step and of the previous one; then
  /// cell states, if used, and those of the previous step, if cells follow them; then, if set from outside, factors of
  /// lateral faces; then overridden activities, if any.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;

  /// Reference areas grow with the faces, by the mean of both cells of a lateral face.
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements,
                                           std::span<const GrowthTensor> tensors) const override;
  /// Faces keep their reference area, per area in the undeformed tissue, and their strain (stress-free / reference
  /// area), also as parts of a face that was cut. The reference area of a face between daughters is its present one.
  /// Where cells meet by an exchange, it is the mean of both cells' other lateral faces; if areas relax, such a face
  /// begins at its stress-free area.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  /// Reference areas of faces born in divisions depend on positions then, and all on growth: reference areas / areas in
  /// the undeformed tissue.
  [[nodiscard]] std::vector<double> past() const override;
  [[nodiscard]] std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange& change, std::span<const Vec3>,
                                              std::span<const double> past) const override;
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions&) const override;

  [[nodiscard]] std::vector<double> program_points_s() const override;
  [[nodiscard]] std::vector<double> program_jumps_s() const override;
  [[nodiscard]] bool is_active() const override { return rule_.tension != 0; }
  [[nodiscard]] std::optional<double> activity_of(CellId cell, double time_s,
                                                  std::span<const double> internal) const override;
  [[nodiscard]] bool accepts(std::span<const double> internal, const Tissue& tissue) const override;
  /// By elastic stiffness and crowding of faces without fibres.
  void add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const override;
  /// Override the activity of the tension; stiffness keeps its program.
  [[nodiscard]] std::vector<double> with_activities(std::span<const double> internal,
                                                    std::span<const double> activities) const override;
  /// Return the internal state with factors on the tension of faces, set from outside; empty: none. A face keeps its
  /// factor as long as its two cells, or their daughters, share it; a face between cells that meet has 1.
  [[nodiscard]] std::vector<double> with_face_factors(std::span<const double> internal,
                                                      std::span<const double> factors) const;
  /// Return them; empty: none.
  [[nodiscard]] std::span<const double> face_factors(std::span<const double> internal) const {
    return memory(internal).factors;
  }
  /// Whether activities read the passive stress of cells, which is then the last signal, kPa.
  [[nodiscard]] bool reads_stress() const {
    return activation_.is_used() && rule_.activation.measure == ShapeMeasure::passive_stress;
  }
  [[nodiscard]] std::vector<double> with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                                 double time_s) const override;

  /// NoGradient where signals start cells, stress acts on them, forces jump where a cell starts, or fibres turn.
  [[nodiscard]] const LawDerivatives& derivatives() const override;
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;
  void add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                             std::span<Vec3> positions, const BeginningGradient& gradient) const override;
  [[nodiscard]] std::vector<double> next_internal_like(const Law& law, const Step& step,
                                                       std::span<const double> next) const override;
  void move_to_signals(std::span<double> by_internal, std::span<const CellArray> signals,
                       std::span<CellArray> by_signals) const override;
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override;
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;
  /// Return the law whose cells start at the interpolated crossing of their threshold.
  [[nodiscard]] std::unique_ptr<Law> smooth() const override;

  [[nodiscard]] CellSide side() const { return rule_.side; }
  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }
  /// Areas (um^2; with fibres, measures) and tensions (nN/um; along them) of the faces at the end of a step.
  [[nodiscard]] std::vector<double> areas(std::span<const Vec3> positions) const;
  [[nodiscard]] std::vector<double> tensions(const Step& step) const;
  [[nodiscard]] std::optional<double> mean_tension(const Step& step) const override;  // over the area

 private:
  friend BatchLaw;
  static constexpr std::array tables = {&generic::face_kernels, &avx2::face_kernels, &avx512::face_kernels};
  struct Response {  // response of a face to its area
    double energy = 0, tension = 0, slope = 0;
  };
  [[nodiscard]] Response respond(std::size_t face, double area, const Step& step, bool with_energy) const;
  // Three terms: T of the program, b(t) k (A/A_0 - 1) with given b (strength included), and crowding.
  [[nodiscard]] Response active(std::size_t face, double area, const Step& step, bool with_energy) const;
  [[nodiscard]] Response elastic(std::size_t face, double area, const Step& step, double b, bool with_energy) const;
  [[nodiscard]] Response crowded(std::size_t face, double area, bool with_energy) const;
  [[nodiscard]] double stiffening_of(std::size_t face, const Step& step) const;
  [[nodiscard]] double activity_of_face(std::size_t face, const Step& step) const;
  void take_factors(const Step& step) const;
  [[nodiscard]] double factor_of(std::size_t face, const Step& step) const;
  void take_mean_factors(const CompletedStep& completed) const;
  struct FaceTensions {                    // all faces at the end of a step
    std::vector<double> tensions, slopes;  // faces, filled up to whole batches
    Vectors positions;                     // what they depend on
    std::vector<double> internal;
    std::array<double, 3> times = {};

    [[nodiscard]] bool are_of(const Step& step) const;
  };
  [[nodiscard]] FaceTensions face_tensions(const Step& step) const;
  [[nodiscard]] FaceArrays kernel_arrays(const Step& step) const;
  // Parts of add_force_gradient; `increases`: of the areas along the adjoint.
  struct Along {
    const Step& step;
    std::vector<double> areas, increases;  // faces
  };
  void add_flow_gradient(const Along& along, const BeginningGradient& gradient) const;
  void add_activation_gradient(const Along& along, std::span<double> of_states) const;
  void add_direction_gradient(const Along& along, std::span<Vec3> previous) const;
  /// Return the active tension of a face at activity 1 of a cell of strength 1.
  [[nodiscard]] double unit_tension(std::size_t face, double area) const;
  /// Return the part of an internal state, or of its gradient, that ShapeActivation has.
  template <class Number>
  [[nodiscard]] std::span<Number> activation_of(std::span<Number> internal) const;
  /// Return the increase of the area of each face along a direction of nodes.
  [[nodiscard]] std::vector<double> area_increases(std::span<const Vec3> positions,
                                                   std::span<const Vec3> direction) const;
  [[nodiscard]] bool flows() const { return rule_.relaxation_s > 0; }
  [[nodiscard]] bool follows() const { return rule_.activation.kind == ShapeActivationRule::Kind::follows; }
  [[nodiscard]] double rest_area_before(std::size_t face, const Step& step) const;
  [[nodiscard]] CortexRule rule_after(const TissueChange& change) const;
  [[nodiscard]] const FibreBatch* fibres() const { return fibres_.empty() ? nullptr : fibres_.data(); }
  void take_fibres(const Tissue& tissue);
  void turn_fibres(const Step& step) const;
  static std::vector<Face> acting_faces(const Tissue& tissue, CellSide side, const CellPattern& pattern);
  class Origins;  // faces before a division that faces after it come from
  void take_rest_areas();
  void take_stretches(std::vector<double> stretches);
  void inherit_faces(const Origins& origins, const Cortex& before, std::span<const Vec3> positions);
  // An internal state, in its order. Parts that are not used are empty.
  struct Memory {
    std::span<const double> areas, areas_before;  // faces; stress-free / reference, at the beginning of both steps
    // Cells; ShapeActivation: now, and, where cells follow it, in the step before.
    std::span<const double> activation, activation_before;
    std::span<const double> factors;  // faces; empty: none set. Activities are given then, too
    GivenActivities given;
  };
  [[nodiscard]] Memory memory(std::span<const double> internal) const;
  [[nodiscard]] std::vector<double> acting_midway(std::span<const double> internal) const;
  using Height = std::optional<double>;  // of a face, percent; empty: of the cell
  [[nodiscard]] double activity(CellId cell, double time_s, std::span<const double> internal, Height height) const;
  [[nodiscard]] double stiffening(CellId cell, const Step& step, Height height) const;
  // Derivatives of both by the state of the cell in ShapeActivation.
  [[nodiscard]] double activity_slope(CellId cell, const Step& step, Height height) const;
  [[nodiscard]] double stiffening_slope(CellId cell, const Step& step, Height height) const;
  // Call body(cell, weight of its parameters in the face, strength included) for the cells of a face.
  template <class Body>
  void for_cells(const Face& face, const Body& body) const;
  template <class OfCell>
  [[nodiscard]] double of_face(std::size_t face, const OfCell& of_cell) const;

  CortexRule rule_;
  CellPattern pattern_;
  std::vector<Face> faces_;         // faces with nonzero strength
  std::vector<double> rest_areas_;  // faces; um^2: A_r
  // Faces, since the last change of the tissue: A_r / area in the undeformed tissue, 1 unless born after it, or / um^2
  // once cells were remeshed, and the area (um^2) from which A_r grows.
  std::vector<double> stretches_, ungrown_areas_;
  bool is_remeshed_ = false;       // cells have exchanged neighbours, or left
  Vectors rest_normals_;           // faces; in the rest shapes of then
  std::vector<double> strengths_;  // faces
  std::vector<double> heights_;    // faces; percent of the height of their cells
  ShapeActivation activation_;
  std::vector<FaceBatch> batches_;
  mutable std::vector<FibreBatch> fibres_;  // empty: none
  // Fibres that turn with their cells: axes, corners of faces in the reference state, positions by which they are.
  CellAxes axes_;
  std::vector<std::array<Vec3, 4>> rest_corners_;
  mutable Vectors turned_at_;
  std::vector<std::uint64_t> pairs_;  // faces; of their cells, if walls have noise
  mutable NoiseOfPairs noise_;
  mutable FaceTensions kept_;  // of the last iterate, for all products of its linear system; one thread at a time
  // Factors of lateral faces (WallFactorRule), by the positions at the beginning of a step and the time at its end.
  struct Factors {
    Vectors positions;
    double time_s = -1;
    std::vector<double> of_face;
  };
  mutable Factors factors_;
};

}  // namespace plica
