// The whole of a symmetric embryo of which one side is solved: what is shown and measured.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/model.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// A whole model, and where it is: as the side that is solved, and as its images. What its laws remember it works out
/// by itself, from step to step.
class Whole {
 public:
  /// At rest.
  Whole(std::unique_ptr<Model> model, Mirror mirror);
  Whole(const Whole& other);
  Whole(Whole&&) noexcept = default;
  Whole& operator=(const Whole&) = delete;
  Whole& operator=(Whole&&) noexcept = default;
  ~Whole() = default;

  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] const State& state() const { return state_; }

  /// How many times the side is in it: 2 or 4.
  [[nodiscard]] double copies() const {
    return static_cast<double>(mirror_.cells.size()) / static_cast<double>(mirror_.origins.size());
  }

  /// The side has taken a step. Gives back where the whole was before it.
  State follow(const Model& side, const State& state);

  /// The side is there, and this is what the whole's laws remember.
  void go_to(const Model& side, const State& state, std::vector<std::vector<double>> internals);

  /// Cells of the whole act by a law as they are told. Gives back what that is for the cells of the side. UsageError
  /// where a cell and its image are told different things.
  std::vector<double> take_activities(std::size_t law, const std::vector<double>& activities);

 private:
  [[nodiscard]] State whole_of(const Model& side, const State& state) const;

  std::unique_ptr<Model> model_;
  Mirror mirror_;
  State state_;
};

}  // namespace plica
