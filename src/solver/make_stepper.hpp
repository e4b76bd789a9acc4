// Choice of the time-stepping scheme requested by a scenario.
#pragma once

#include <memory>
#include <optional>

#include "solver/linear/directions.hpp"
#include "solver/projection/volume_projection.hpp"
#include "solver/step/backward_difference.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// Description of a scheme.
struct StepScheme {
  enum class Forces { newton, linearly_implicit } forces = Forces::newton;
  TimeOrder order = TimeOrder::first;                    // second: newton, no projection, no inertia
  LinearMethod linear_method = LinearMethod::automatic;  // newton
  double linear_tolerance = 1e-6;     // linearly implicit: residual of the linear system over its right side
  int most_linear_iterations = 2000;  // linearly implicit
  std::optional<ProjectionRule> projection;
};

std::unique_ptr<Stepper> make_stepper(const Model& model, const StepScheme& scheme);

}  // namespace plica
