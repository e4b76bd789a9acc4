#include "solver/linear/iterate.hpp"

namespace plica {

FactorMemory factor_memory(const Step& step, const Iterate& at) {
  const auto copy = [](std::span<const Vec3> vectors) { return Vectors(vectors.begin(), vectors.end()); };
  FactorMemory memory;
  memory.at = at;
  memory.previous_positions = copy(step.previous_positions);
  memory.previous_velocities = copy(step.previous_velocities);
  memory.earlier_positions = copy(step.earlier_positions);
  memory.rate_s = step.rate_s;
  memory.end_time_s = step.end_time_s;
  memory.ahead = step.ahead;
  memory.internals.assign(step.internals.begin(), step.internals.end());
  return memory;
}

Step step_of(const FactorMemory& memory) {
  return {.positions = memory.at.positions,
          .previous_positions = memory.previous_positions,
          .previous_velocities = memory.previous_velocities,
          .rate_s = memory.rate_s,
          .end_time_s = memory.end_time_s,
          .earlier_positions = memory.earlier_positions,
          .ahead = memory.ahead,
          .internals = memory.internals};
}

std::vector<int> pattern_revisions(const Model& model, const Step& step) {
  std::vector<int> revisions;
  for_laws(model, step,
           [&](const Law& law, const Step& own) { revisions.push_back(law.pattern_revision(own.internal)); });
  return revisions;
}

}  // namespace plica
