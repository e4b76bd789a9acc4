#include "output/mesh_writer.hpp"

namespace plica {
namespace {

// A value a cell as one an element.
template <class Values>
std::vector<double> of_elements(const Tissue& tissue, const Values& of_cells) {
  std::vector<double> values;
  values.reserve(tissue.elements.size());
  for (const CellId cell : tissue.element_cell) values.push_back(static_cast<double>(of_cells[cell.index()]));
  return values;
}

}  // namespace

Frame frame_of(const Tissue& tissue, std::span<const Vec3> positions, const MeshArrays& arrays) {
  Frame frame;
  frame.positions.assign(positions.begin(), positions.end());
  frame.elements = tissue.elements;
  for (const auto& [name, vectors] : arrays.node_vectors)
    frame.node_vectors[name].assign(vectors.begin(), vectors.end());
  for (const auto& [name, values] : arrays.cell_scalars) frame.element_scalars[name] = of_elements(tissue, values);
  for (const auto& [name, values] : arrays.cell_integers) frame.element_scalars[name] = of_elements(tissue, values);
  return frame;
}

}  // namespace plica
