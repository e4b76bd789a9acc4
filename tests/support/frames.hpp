// Frames for tests, made from a mesh without a run.
#pragma once

#include "support/testing.hpp"
#include "tissue/files/frame_file.hpp"
#include "tissue/tissue.hpp"

namespace plica::support {

/// A mesh at rest as a frame: cell_id of each element, displacement_um of each node as given (zero where not).
inline Frame frame_of(const Tissue& tissue, const Vectors& displacements = {}) {
  Frame frame;
  frame.positions = tissue.rest_positions;
  frame.elements = tissue.elements;
  std::vector<double>& cells = frame.element_scalars["cell_id"];
  cells.resize(tissue.elements.size());
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    for (int i = 0; i < tissue.cells[c].element_count; ++i)
      cells[tissue.cells[c].first_element.index() + static_cast<std::size_t>(i)] = static_cast<double>(c);
  frame.node_vectors["displacement_um"] =
      displacements.empty() ? Vectors(frame.positions.size(), Vec3::Zero()) : displacements;
  return frame;
}

}  // namespace plica::support
