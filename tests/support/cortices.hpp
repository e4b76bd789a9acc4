// Cortices of tests.
#pragma once

#include "mechanics/active/cortex.hpp"
#include "support/testing.hpp"

namespace plica::support {

/// All that a cortex can be, with numbers of the furrow's size and programs that rise and fall within a step.
inline CortexRule whole_cortex(CellSide side) {
  return {.side = side,
          .tension = 1.4,
          .saturation = 0.16,
          .stiffness = 0.7,
          .compression_ratio = 0.1,
          .crowding = 0.02,
          .relaxation_s = 2,
          .program = Program({0, 2}, {0, 1}),
          .stiffness_program = Program({0, 4}, {1, 0.1})};
}

}  // namespace plica::support
