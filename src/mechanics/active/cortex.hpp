// The cortex: a thin, active, elastic layer on apical, basal or lateral faces of cells (docs/theory/cortex.md).
//
// The tension T of a face, nN/um, is a function of its area A alone, the same in all directions:
//   T = a(t) gamma A/(A + A_s) + b(t) k (A/A_0 - 1) - c (A_r/A)^2,
// a and b the programs, A_r the face's area at rest, A_s = saturation A_r, and A_0 the rest area, which is A_r or flows
// after the area: dA_0/dt = (A - A_0)/tau. Where A < A_0, k is `compression_ratio` times smaller.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/given_activities.hpp"
#include "mechanics/active/own_state.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/face_kernels.hpp"
#include "mechanics/kernels/kernels.hpp"
#include "mechanics/law.hpp"
#include "tissue/faces.hpp"

namespace plica {

/// What a cortex is like. As in the scenario's [cortex.NAME].
struct CortexRule {
  CellSide side = CellSide::apical;
  double tension = 0;              // gamma, nN/um
  double saturation = 0;           // A_s over the area at rest
  double stiffness = 0;            // k, nN/um
  double compression_ratio = 1;    // 0: slack
  double crowding = 0;             // c, nN/um
  double relaxation_s = 0;         // tau; 0: the rest area does not flow
  Program program = {};            // of gamma; a cell's begins after its delay
  Program stiffness_program = {};  // of k
  OwnStateRule own = {};           // what starts both programs, or scales the tension, in each cell
};

/// Cells' strengths scale all of it. A wall is the cortex of the two cells that share it: it has the mean of what they
/// are told, nothing from one that does not act; at a rim, where there is one cell, what that is told; on a mirror
/// plane or at the end of a slice, whose other side has the rest, a half of that. The semidefinite tangent leaves out
/// faces under compression and what changes of shape within a face give.
class Cortex final : public Law {
 public:
  Cortex(const Tissue& tissue, CellPattern pattern, CortexRule rule, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "cortex"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Cortex>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;

  /// Where rest areas flow: those at the beginning of the step, then those at the beginning of the step before. Then
  /// the cells' own states, where these matter; then activities that are given from outside.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;

  /// Faces of daughters have the strain of their mother's: rest areas over areas at rest. A wall between daughters is
  /// as it is at rest.
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_division(std::span<const double> internal, const Tissue& tissue,
                                                            const Division& division) const override;

  [[nodiscard]] std::vector<double> program_points_s() const override;
  [[nodiscard]] std::vector<double> program_jumps_s() const override;
  [[nodiscard]] bool is_active() const override { return rule_.tension != 0; }
  [[nodiscard]] std::optional<double> activity_of(CellId cell, double time_s,
                                                  std::span<const double> internal) const override;
  /// Of the tension: stiffness keeps its program.
  [[nodiscard]] std::vector<double> with_activities(std::span<const double> internal,
                                                    std::span<const double> activities) const override;

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const CellPattern& pattern() const { return pattern_; }
  /// Areas and tensions at a step's end; faces.
  [[nodiscard]] std::vector<double> areas(std::span<const Vec3> positions) const;
  [[nodiscard]] std::vector<double> tensions(const Step& step) const;

 private:
  struct Response {  // of a face to its area
    double energy = 0, tension = 0, slope = 0;
  };
  [[nodiscard]] Response respond(std::size_t face, double area, const Step& step, bool with_energy) const;
  // Its three terms: T of the program, b(t) k (A/A_0 - 1) with a given b (strength included), and crowding.
  [[nodiscard]] Response active(std::size_t face, double area, const Step& step, bool with_energy) const;
  [[nodiscard]] Response elastic(std::size_t face, double area, const Step& step, double b, bool with_energy) const;
  [[nodiscard]] Response crowded(std::size_t face, double area, bool with_energy) const;
  [[nodiscard]] double stiffening_of(std::size_t face, const Step& step) const;
  struct Pull;  // of all faces at a step's end, as kernels take it
  [[nodiscard]] Pull pull(const Step& step) const;
  [[nodiscard]] bool flows() const { return rule_.relaxation_s > 0; }
  [[nodiscard]] double rest_area_before(std::size_t face, const Step& step) const;
  [[nodiscard]] std::vector<double> rest_areas_after_division(std::span<const double> internal, const Tissue& tissue,
                                                              const Division& division) const;
  [[nodiscard]] std::size_t area_numbers() const { return flows() ? 2 * faces_.size() : 0; }
  [[nodiscard]] std::size_t own_numbers() const {
    return area_numbers() + (own_.is_used() ? pattern_.cells.size() : 0);
  }
  [[nodiscard]] GivenActivities given(std::span<const double> internal) const { return {internal, own_numbers()}; }
  [[nodiscard]] double activity(CellId cell, double time_s, std::span<const double> internal) const;
  [[nodiscard]] double stiffening(CellId cell, const Step& step) const;
  template <class OfCell>
  [[nodiscard]] double of_face(std::size_t face, const OfCell& of_cell) const;
  [[nodiscard]] const FaceKernels& kernels() const;

  CortexRule rule_;
  CellPattern pattern_;
  Kernels kernels_;
  std::vector<Face> faces_;         // that have any strength
  std::vector<double> rest_areas_;  // faces; um^2: A_r
  std::vector<double> strengths_;   // faces
  OwnState own_;
  ElementChunks chunks_;
  std::vector<FaceBatch> batches_;
};

}  // namespace plica
