// Terms of a solved step that parameters change, for derivatives by two models (docs/theory/gradients.md).
#pragma once

#include <vector>

#include "solver/sensitivity/taped_run.hpp"

namespace plica {

/// Internal states of all laws, or changes of them.
using LawInternals = std::vector<std::vector<double>>;

struct TermsWanted {
  std::vector<bool> internals = {};  // laws
  bool signals = false;
};

/// Terms of a model at a solved iterate.
struct StepTerms {
  Vectors forces;              // nodes: of laws, held constraints and touched obstacles; nN
  std::vector<double> excess;  // all constraints: value - target; 0 if not held
  Vectors moved;               // nodes: to their obstacles, along free normals; um; empty without contacts
  LawInternals internals;      // at the end of the step; empty for laws where none is wanted or parameters do not act
  Signals::Values signals;     // at the end of the step; empty if not wanted
};

/// Return the terms of a model, not grown, at a step of a run.
StepTerms step_terms(const Model& model, const TapedRun& run, std::size_t number, const TermsWanted& wanted);

/// What signals change by in a step: positions at both ends, and signals at its beginning.
struct SignalInput {
  const Vectors &begin, &end;
  const Signals::Values& before;
};
/// Return the signals at the end of a step of a run, by a model as grown there.
Signals::Values signals_after(const Model& model, const TapedRun& run, std::size_t number, const SignalInput& input);

/// Whether any node touches an obstacle.
bool touches_obstacles(const Iterate& at);

}  // namespace plica
