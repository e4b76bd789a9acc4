#include "solver/make_stepper.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "solver/projection/projected_stepper.hpp"
#include "solver/step/newton_stepper.hpp"

namespace plica {

std::unique_ptr<Stepper> make_stepper(const Model& model, const StepScheme& scheme) {
  if (scheme.order == TimeOrder::second &&
      (scheme.projection || scheme.forces != StepScheme::Forces::newton || !model.masses().empty()))
    throw std::logic_error("steps of second order are Newton's, without projection or inertia");
  if (scheme.forces != StepScheme::Forces::newton || scheme.projection)
    for_held_constraints(model, [&](const Constraint& constraint, std::size_t, std::size_t) {
      throw std::logic_error(
          fmt::format("\"{}\" requires Newton's method: the projection keeps only the volumes of "
                      "cells, and the linearly implicit scheme none",
                      constraint.name()));
    });
  if (scheme.forces == StepScheme::Forces::newton && !scheme.projection)
    return std::make_unique<NewtonStepper>(model, StepTolerances{}, scheme.linear_method, scheme.order);
  // Only Newton's step holds obstacles by itself.
  if (scheme.forces == StepScheme::Forces::linearly_implicit)
    return std::make_unique<ProjectedStepper>(
        model, std::make_unique<LinearlyImplicit>(model, scheme.linear_tolerance, scheme.most_linear_iterations),
        scheme.projection);
  return std::make_unique<ProjectedStepper>(
      model, std::make_unique<NewtonStepper>(model, StepTolerances{}, scheme.linear_method), scheme.projection);
}

}  // namespace plica
