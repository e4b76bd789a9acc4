// Signals: numbers per cell that have sources, decay, react, and diffuse through lateral faces
// (docs/theory/signals.md).
//
// A signal has the concentration c in a cell of volume V, thus the amount c V. In a step of length h
//   exp(k h) V c' + p h sum_faces D A/d (c' - c'_beyond) = V c + p h V (s + r),   p = (exp(k h) - 1)/(k h),
// with decay rate k, source s, reaction r at the beginning of the step, face area A and distance d of the two cell
// centres: implicit Euler, but exact for decay and sources. Amounts are conserved and stay positive for any step, as
// the matrix is an M-matrix. A step with reactions is divided until these change little within a part (signals.cpp).
// Rejected: schemes of second order, which are not positive; operator splitting, whose stationary state depends on h.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mechanics/signals/reaction.hpp"
#include "tissue/faces.hpp"
#include "tissue/tissue.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Parameters of a signal, as in [signal.NAME] of the scenario; concentrations are in a unit of the user's.
struct SignalRule {
  std::string name;
  double diffusion = 0;  // D, um^2/s
  double decay = 0;      // k, 1/s
  CellArray initial;     // cells; concentrations
  CellArray sources;     // cells; s, per second
  std::string reaction;  // r, per minute; empty: none
  std::map<std::string, double> constants = {};

  static auto parts_by_cell(auto& rule) { return std::tie(rule.initial, rule.sources); }
};

/// Cause and place of a step of signals that failed.
struct SignalFailure {
  std::string problem;
  CellId cell;
  std::string remedy;
};

/// Return the names that reactions may use as variables: signals, then measures of a cell.
std::vector<std::string> reaction_variables(const std::vector<std::string>& signals);

/// Signals of a model. Concentrations are a list of arrays, one per signal (State::signals).
class Signals {
 public:
  using Values = std::vector<CellArray>;

  Signals() = default;
  Signals(const Tissue& tissue, std::vector<SignalRule> rules);

  [[nodiscard]] bool empty() const { return rules_.empty(); }
  [[nodiscard]] std::size_t size() const { return rules_.size(); }
  [[nodiscard]] const std::vector<SignalRule>& rules() const { return rules_; }
  [[nodiscard]] Values initial() const;

  /// Geometry of a step: cell volumes at its beginning, and volumes (um^3) and node positions at its end.
  struct Geometry {
    std::span<const double> volumes_before, volumes;
    const Vectors& positions;
  };
  /// Advance the concentrations by `duration_s`. On failure they are unchanged.
  [[nodiscard]] std::optional<SignalFailure> advance(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                                     Values& values) const;

  /// Gradient of an outcome by the geometry of a step.
  struct GeometryGradient {
    std::vector<double> volumes_before, volumes;  // cells
    std::span<Vec3> positions;                    // nodes
  };
  /// Return the gradient of an outcome by the concentrations before a step from that by those after it, and add that by
  /// its geometry. The number of parts of the step is a constant.
  [[nodiscard]] Values pull_back(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                 const Values& before, Values gradient, GeometryGradient& by_geometry) const;

  /// Return the signals of the tissue after a change.
  [[nodiscard]] Signals after(const Tissue& tissue, const TissueChange& change) const;

 private:
  struct Diffusion;
  struct Chemistry;
  struct Parts;
  /// Take a step and keep its parts.
  [[nodiscard]] std::optional<SignalFailure> take_parts(const Tissue& tissue, const Geometry& geometry,
                                                        double duration_s, const Values& values, Parts& result) const;
  void add_conductance_gradient(const Tissue& tissue, const Vectors& positions, std::span<const double> of_faces,
                                std::span<Vec3> gradient) const;
  [[nodiscard]] std::vector<double> conductances(const Tissue& tissue, const Vectors& positions) const;

  std::vector<SignalRule> rules_;
  std::vector<Face> faces_;  // lateral faces between two cells
};

/// Return concentrations after a change: cells inherit them, scaled by the ratio of the volumes so that the amount in
/// the descendants of a cell is what it had.
Signals::Values inherited_signals(const TissueChange& change, std::span<const double> volumes_before,
                                  std::span<const double> volumes_after, const Signals::Values& values);

/// Whether no concentration has changed by more than 0.1 % per minute of the largest of its signal.
bool are_at_rest(const Signals::Values& before, const Signals::Values& after, double duration_s);

}  // namespace plica
