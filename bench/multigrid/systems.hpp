// Systems of plica's own steps, as its solver gives them to a preconditioner.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/algebra/sparse_pattern.hpp"

namespace plica::multigrid_bench {

struct System {
  BlockPattern pattern;
  std::vector<float> values, near_kernel;
  std::size_t elements = 0;
};

struct SystemSettings {
  std::array<int, 3> elements_per_cell = {1, 1, 1};
  int scale = 1;  // of the embryo's length and diameter and its counts of cells
  double step_s = 5;
  double bulk_modulus = 10;  // kPa: of the volumes' part
  int free_of = 0;           // every so many apical nodes one is free; 0: none, 1: all
};

/// The first step of the Drosophila contraction.
System make_system(const SystemSettings& settings);

}  // namespace plica::multigrid_bench
