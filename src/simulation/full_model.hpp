// Full model of a symmetric embryo of which one side is solved; used for output and measures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/model.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// Full model with its state, composed of the solved side and its mirror images. Internal variables of its laws are
/// updated from step to step.
class FullModel {
 public:
  /// Starts in the reference state.
  FullModel(Model model, Mirror mirror);

  [[nodiscard]] const Model& model() const { return grown_ ? *grown_ : model_; }
  [[nodiscard]] const State& state() const { return state_; }

  /// Number of copies of the side in the full model: 2 or 4.
  [[nodiscard]] double copies() const {
    return static_cast<double>(mirror_.cells.size()) / static_cast<double>(mirror_.origins.size());
  }

  /// Update after a step of the side. Returns the state of the full model before it.
  State follow(const Model& side, const State& state);

  void go_to(const Model& side, const State& state, std::vector<std::vector<double>> internals);

  /// Override activities of a law; cells of the full model. Returns those of the side. Throws UsageError unless mirror
  /// images have equal activities.
  std::vector<double> take_activities(std::size_t law, const std::vector<double>& activities);
  /// Replace the concentrations of a signal, likewise.
  CellArray take_signal(std::size_t signal, const CellArray& values);

  /// Multiply the strengths of cells in a law; cells of the full model. Returns the factors of the side. Throws
  /// UsageError unless mirror images have equal factors.
  std::vector<double> scale_strengths(std::size_t law, const std::vector<double>& factors);

  [[nodiscard]] const Mirror& mirror() const { return mirror_; }

 private:
  [[nodiscard]] std::vector<double> of_side(const std::string& what, const std::string& noun,
                                            const std::vector<double>& values) const;
  [[nodiscard]] State whole_of(const Model& side, const State& state) const;
  void grow(double time_s);

  Model model_;
  std::optional<Model> grown_;  // at the time of its state, if cells have grown
  Mirror mirror_;
  State state_;
};

}  // namespace plica
