// Growth of cells without division, and of daughters after one: rest shapes, target volumes and rest areas as functions
// of time. Theory: docs/theory/growth.md.
//
// A cell that grows has the tensor G, so that F = F_e G: its rest shape is G times that of the model, its target volume
// det G times. All laws stretch along the same three axes of a cell, so their tensors multiply in any order.
#pragma once

#include <algorithm>
#include <optional>
#include <tuple>
#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/followed_signal.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/derivatives.hpp"

namespace plica {

struct Model;

/// Growth of a daughter cell from half of its mother to its final size, linear in time.
struct Growth {
  CellId cell;
  std::vector<Vec3> rest_from, rest_to;   // um; corners, as Cell::rest_shape
  double target_from = 0, target_to = 0;  // volume, um^3
  double start_s = 0, end_s = 0;

  /// Return the completed fraction, 0 to 1.
  [[nodiscard]] double part(double time_s) const;

  static auto parts(auto& growth) {
    return std::tie(growth.cell, growth.rest_from, growth.rest_to, growth.target_from, growth.target_to, growth.start_s,
                    growth.end_s);
  }
};

/// Growth of a cell since the last change of the tissue.
struct GrowthTensor {
  Mat3 G = Mat3::Identity();
  double volume = 1;  // det G

  /// Return the ratio by which a face with this unit normal grows.
  [[nodiscard]] double area(const Vec3& normal) const { return volume * (G.inverse() * normal).norm(); }
};

/// Parameters as in [growth.NAME] of the scenario: ln V of a cell increases at the rate strength x activity x `rate`.
struct GrowthRule {
  double rate_per_s = 0;
  Vec3 shares;  // of ln V: along, across, and in height; their sum is 1
  Program program = {};
  ShapeActivationRule follow = {};  // signal that scales the activity
};

/// Growth that the scenario prescribes: a law without forces that remembers for how long each cell has been active
/// since the last change of the tissue, which takes the shapes of then for those of the model.
class CellGrowth final : public Law, public LawDerivatives {
 public:
  CellGrowth(const Tissue& tissue, CellPattern pattern, GrowthRule rule);

  [[nodiscard]] std::string_view name() const override { return "growth"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<CellGrowth>(*this); }
  [[nodiscard]] double energy(const Step&) const override { return 0; }
  void add_forces(const Step&, std::span<Vec3>) const override {}
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}
  void add_tangent(const Step&, TangentSink&) const override {}

  /// NoGradient where cells follow a signal.
  [[nodiscard]] const LawDerivatives& derivatives() const override;
  /// Factors on rates of growth.
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;
  [[nodiscard]] bool strengths_change_cells() const override { return true; }

  void grow(std::span<const double> internal, double time_s, std::vector<GrowthTensor>& tensors) const override;
  [[nodiscard]] bool is_growing(std::span<const double> internal, double time_s) const override;

  /// Return the time, then the integral of activity of each cell since the last change, s; then what FollowedSignal
  /// has; then overridden activities, if any.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions&) const override;

  [[nodiscard]] std::vector<double> program_points_s() const override { return rule_.program.times_s(); }
  [[nodiscard]] bool is_active() const override { return true; }
  [[nodiscard]] std::optional<double> activity_of(CellId cell, double time_s,
                                                  std::span<const double> internal) const override;
  [[nodiscard]] std::vector<double> with_activities(std::span<const double> internal,
                                                    std::span<const double> activities) const override {
    return given(internal).put(internal, activities);
  }
  [[nodiscard]] std::vector<double> with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                                 double time_s) const override;
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }

 private:
  [[nodiscard]] GivenActivities given(std::span<const double> internal) const {
    return GivenActivities(internal.subspan(std::min(internal.size(), 1 + pattern_.cells.size() + followed_.size())));
  }
  /// Return the part of an internal state that FollowedSignal has.
  template <class Number>
  [[nodiscard]] std::span<Number> followed(std::span<Number> internal) const {
    return internal.subspan(1 + pattern_.cells.size(), followed_.size());
  }
  [[nodiscard]] double active_s(CellId cell, std::span<const double> internal, double time_s) const;

  GrowthRule rule_;
  CellPattern pattern_;
  FollowedSignal followed_;
  ByCell<Mat3> axes_;  // columns: along, across and from base to apex, in the rest shape
};

/// Whether a law of the model lets cells grow or shrink just after a time.
bool cells_grow(const Model& model, std::span<const std::vector<double>> internals, double time_s);

/// Return the model with the rest shapes, target volumes and rest areas that cells have at `time_s`; empty if `present`
/// has them: the model itself, or one that this function made of it earlier. They follow from `model`, `internals` (its
/// laws' states before that time; none: only daughters grow) and the time alone.
std::optional<Model> grown(const Model& model, const Model& present, std::span<const std::vector<double>> internals,
                           double time_s);

}  // namespace plica
