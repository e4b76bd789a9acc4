// Gradient of an outcome with respect to parameters: the adjoint of all steps of a run, last step first
// (docs/theory/gradients.md).
//
// A step solves  F(x, before, p) + J^T l + N f = 0,  c(x) = target(p),  g(x, p) = 0 on touched obstacles. With a the
// gradient of the outcome by x,
//   [ A  -J^T ] [ mu ]   [ a ]
//   [ -J   0  ] [ nu ] = [ 0 ]
// gives its gradient by everything else: mu . dF/d(before, p) - nu . dtarget/dp, and what moves obstacles. Gradients by
// internal states are passed on by the laws.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/derivatives.hpp"
#include "solver/sensitivity/exact_solve.hpp"
#include "solver/sensitivity/taped_run.hpp"

namespace plica {

/// Gradients of an outcome by the positions of some states of a run; by number of the state. One Vec3 per node.
using OutcomeGradient = std::map<std::size_t, Vectors>;

/// Parameter of which two models are known, on both sides of the run's. Models differ in forces, targets and gaps only.
struct ModelPair {
  std::string name;
  std::unique_ptr<const Model> more, less;
  double difference = 0;  // of the parameter, more - less
};

/// Return the pair. NoGradient, with the name, if the models differ from `model` in what a run begins with: tissue,
/// laws, memories, reference state.
ModelPair model_pair(const Model& model, std::string name, std::unique_ptr<const Model> more,
                     std::unique_ptr<const Model> less, double difference);

/// What a gradient is wanted of, and how accurately.
struct GradientInput {
  std::vector<const ModelPair*> parameters = {};
  std::optional<std::size_t> law = {};  // index of the law of which the strengths of cells are parameters
  // The law with strengths of factor 1, if not that of the model.
  const Law* unscaled_law = nullptr;
  // Present strengths of cells, where they do not act by forces of the law (LawDerivatives::strengths_change_cells);
  // empty: 1.
  std::vector<double> factors = {};
  double tolerance = 1e-9;  // relative, of linear solves
  std::function<bool()> stop_requested = {};
};

struct RunGradient {
  std::vector<double> by_parameter;
  std::vector<double> by_strength;  // cells; by a factor on the strength of each in the law
  int linear_iterations = 0, factorisations = 0;
};

/// Throws NoGradient if a law of the model has no derivatives, UsageError if `law` has no strengths, std::runtime_error
/// if a solve fails. Empty if stopped.
std::optional<RunGradient> way_back(const Model& model, const TapedRun& run, LinearMethod method,
                                    const OutcomeGradient& outcome, const GradientInput& input);

/// Throw NoGradient if a law has no derivatives.
void require_derivatives(const Model& model);

}  // namespace plica
