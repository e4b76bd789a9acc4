// What a law remembers from step to step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mechanics/step.hpp"

namespace plica {

struct Tissue;

/// Internal state of a law (stress-free lengths, contact pairs): an array of numbers held by State, so that checkpoints
/// and rejected steps need no knowledge of laws. Each law has a view that names its numbers. By default there are none.
class LawMemory {
 public:
  /// Return the internal state before the first step, or at the end of a converged step (which may still be rejected
  /// for its error; the law is not notified). A law that remembers what changes at a rate keeps it twice, for the
  /// beginning of this step and of the step before, since steps of second order need both (Step::extrapolated). With
  /// mirror planes the law exists twice, for the solved side and for the whole tissue (FullModel): both are asked.
  [[nodiscard]] virtual std::vector<double> first_internal(const Tissue& /*tissue*/) const { return {}; }
  [[nodiscard]] virtual std::vector<double> next_internal(const Step& step) const {
    return {step.internal.begin(), step.internal.end()};
  }
  /// Return the internal state of the law of the whole tissue that this one, of a side, implies; or nothing, and that
  /// law finds it itself.
  [[nodiscard]] virtual std::optional<std::vector<double>> internal_of_whole(
      std::span<const double> /*of_side*/) const {
    return std::nullopt;
  }
  /// Whether the law can read an internal state of a checkpoint. The default is for states of constant length.
  [[nodiscard]] virtual bool accepts(std::span<const double> internal, const Tissue& tissue) const {
    return internal.size() == first_internal(tissue).size();
  }

 protected:
  ~LawMemory() = default;
};

}  // namespace plica
