// Tape: a run that was recorded for gradients of its outcomes (docs/theory/gradients.md).
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "measure/smooth_outcome.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"
#include "solver/sensitivity/tangents.hpp"
#include "solver/sensitivity/way_back.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// Solver failure of a recorded run.
struct RecordingFailed : std::runtime_error {
  RecordingFailed(const Simulation& simulation)
      : std::runtime_error(simulation.failure()), cell(simulation.failed_cell()), time_s(simulation.time_s()) {}
  std::optional<int> cell;
  double time_s;
};

/// Factors on the strengths of cells by law identifier; one per cell of the whole embryo.
using StrengthFactors = std::map<std::string, std::vector<double>>;

/// Adds to the parts of a simulation what a scenario does not hold: laws of the caller.
using PartsAddition = std::function<void(Simulation::Parts&)>;

struct RecordingInput {
  std::vector<double> at_s = {};  // times on which steps end, ascending; then the run continues to its end
  double until_s = std::numeric_limits<double>::infinity();
  StrengthFactors strengths = {};
  PartsAddition add = {};
  std::function<bool()> stop_requested = {};
};

/// Recorded run, and gradients of functions of its positions. Positions and cells are those of the whole embryo, also
/// if one side is solved. Gradients are exact for the recorded steps: their ends and orders are constants, and so are
/// which cells divide or exchange neighbours, and after which step. At a state where they do, the tissue is that after.
class Tape {
 public:
  /// Run the scenario and record it. Throws as Simulation does; NoGradient if a law has no derivatives;
  /// RecordingFailed.
  Tape(const Scenario& scenario, const RecordingInput& input);

  /// Tissue at the start.
  [[nodiscard]] const Tissue& tissue() const { return whole_->tissue; }
  /// Tissue at a state.
  [[nodiscard]] const Tissue& tissue(std::size_t state) const { return model_at(state).tissue; }
  [[nodiscard]] std::size_t steps() const { return parts_.back().first_state + parts_.back().run.steps(); }
  /// Number of times at which cells divided or exchanged neighbours.
  [[nodiscard]] std::size_t changes() const { return parts_.size() - 1; }
  /// Return times of all states.
  [[nodiscard]] std::vector<double> times_s() const;
  /// Whether recording was stopped before the end.
  [[nodiscard]] bool was_stopped() const { return was_stopped_; }
  /// Return positions after a number of steps, um.
  [[nodiscard]] Vectors positions(std::size_t state) const;
  /// Return the number of the state at a time. UsageError if no step ends then.
  [[nodiscard]] std::size_t state_at(double time_s) const;

  /// Return an output variable after a number of steps, and its gradient by positions (smooth_outcome). NoGradient
  /// after a change of the tissue for outcomes that are relative to the reference state, which follows from the change.
  [[nodiscard]] SmoothOutcome outcome(const std::string& name, std::size_t state) const;

  /// Scenario and addition of a changed run; without one, the addition of this run.
  struct Variant {
    Variant(const Scenario& changed, PartsAddition addition = {})  // NOLINT: meant to convert
        : scenario(changed), add(std::move(addition)) {}
    const Scenario& scenario;
    PartsAddition add;
  };
  /// Return a key, or a number of an added law, as a parameter, from runs with a larger and a smaller value of it.
  /// NoGradient as model_pair, and for keys of divisions, exchanges and extrusions, which are constants of the run.
  [[nodiscard]] ModelPair parameter(std::string name, const Variant& more, const Variant& less,
                                    double difference) const;

  struct Wanted {
    std::vector<const ModelPair*> parameters = {};
    std::string law = {};  // of which the strengths of cells are parameters; empty: none
    double tolerance = 1e-9;
    std::function<bool()> stop_requested = {};
  };
  /// Return the gradient of an outcome, given by its gradients by positions. If one side is solved, mirror images
  /// share the derivative by their common strength equally. After a change of the tissue it is found by tangents, of
  /// each cell for strengths. Empty if stopped.
  [[nodiscard]] std::optional<RunGradient> gradient(const OutcomeGradient& outcome, const Wanted& wanted) const;

  /// Return the derivatives of outcomes by parameters, one row per outcome, by tangents: up to about twenty parameters,
  /// and many outcomes, for about the price of a run. Empty if stopped.
  [[nodiscard]] std::optional<std::vector<std::vector<double>>> jacobian(const std::vector<OutcomeGradient>& outcomes,
                                                                         const TangentInput& wanted) const;

  /// Return the derivatives of positions at some states along a change of strengths: of factors, by law and cell. Empty
  /// if stopped.
  [[nodiscard]] std::optional<std::vector<Vectors>> tangent(const StrengthFactors& change,
                                                            std::span<const std::size_t> states,
                                                            const TangentInput& wanted) const;

  /// Repeat the same steps with tight tolerances, for a changed run or other strengths: an oracle of gradients.
  [[nodiscard]] Tape replayed(const Variant& changed, const StrengthFactors& strengths) const;
  [[nodiscard]] const Scenario& scenario() const { return *scenario_; }
  /// Return the mirror of the whole embryo to the solved side; not used if all is solved.
  [[nodiscard]] const Mirror& mirror() const { return mirror_; }
  [[nodiscard]] const StrengthFactors& strengths() const { return strengths_; }

 private:
  class Recording;
  Tape() = default;
  [[nodiscard]] const TapedPart& part_of(std::size_t state) const { return parts_[part_with(parts_, state)]; }
  [[nodiscard]] const TapedState& taped_state(std::size_t state) const;
  /// Return the model at a state, of the whole embryo, not grown.
  [[nodiscard]] const Model& model_at(std::size_t state) const {
    const TapedPart& part = part_of(state);
    return part.change ? *part.model : *whole_;
  }
  [[nodiscard]] std::optional<RunGradient> gradient_by_tangents(const OutcomeGradient& outcome,
                                                                const Wanted& wanted) const;
  [[nodiscard]] const PartsAddition& addition_of(const Variant& changed) const {
    return changed.add ? changed.add : add_;
  }
  [[nodiscard]] std::unique_ptr<Model> solved_model(const Variant& changed) const;
  /// Return the solved model with factors on strengths changed by this times a change of each cell of the whole embryo.
  [[nodiscard]] std::unique_ptr<Model> solved_model(const StrengthFactors& change, double times) const;
  /// Return the gradient by positions of the solved side.
  [[nodiscard]] OutcomeGradient of_solved_side(const OutcomeGradient& outcome) const;

  std::shared_ptr<const Scenario> scenario_;
  PartsAddition add_;
  std::shared_ptr<const Model> whole_, solved_;
  std::vector<std::vector<double>> first_internals_;               // laws of the whole embryo
  std::vector<std::shared_ptr<const MeasurePlan>> measure_plans_;  // parts
  std::map<std::size_t, std::shared_ptr<const Law>> unscaled_;     // laws with other strengths than the scenario's
  Mirror mirror_;                                                  // of the whole embryo to the solved side
  StrengthFactors strengths_;
  RunMethod method_;
  std::vector<TapedPart> parts_;
  bool was_stopped_ = false;
};

}  // namespace plica
