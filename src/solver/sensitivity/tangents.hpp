// Forward sensitivities: derivatives of the states of a run by parameters, first step first (docs/theory/gradients.md).
//
// With q what a step begins with, the derivatives x' and l' of its positions and multipliers by a parameter p solve
//   [ A  -J^T ] [ x' ]   [ dF/dp + dF/dq q' ]
//   [ -J   0  ] [ l' ] = [ -dtarget/dp      ]   with x' along fixed directions from the motion of touched obstacles.
// One factorization per step serves all parameters, so a few parameters and many outcomes cost less than one way back
// per outcome.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "solver/sensitivity/way_back.hpp"

namespace plica {

/// Parameters of tangents, and accuracy.
struct TangentInput {
  std::vector<const ModelPair*> parameters = {};
  double tolerance = 1e-9;  // relative, of linear solves
  std::function<bool()> stop_requested = {};
};

/// Callback after each step: number of the state, and derivatives of its positions by each parameter (nodes).
using TakeTangents = std::function<void(std::size_t state, std::span<const Vectors> by_parameter)>;

/// Pass through the steps and changes of a run up to a state. Both models of a parameter go through each change, from
/// states along its tangent. Returns false if stopped. Throws as way_back; NoGradient if a change has another result
/// there, or if contacts follow it.
bool tangents(std::span<const TapedPart> parts, LinearMethod method, std::size_t last_state, const TangentInput& input,
              const TakeTangents& take);

}  // namespace plica
