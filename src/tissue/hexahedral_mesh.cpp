#include "tissue/hexahedral_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "tissue/lattice.hpp"
#include "tissue/mesh_faces.hpp"
#include "tissue/mesher.hpp"

namespace plica {
namespace {

constexpr double largest_coordinate_um = 1e9;  // a kilometre: beyond it products of lengths lose their meaning

void check_size(const HexahedralMesh& mesh, const std::array<int, 3>& elements) {
  const auto [along, across, radial] = elements;
  if (mesh.cells.empty()) throw MeshError("the mesh has no cells");
  if (along < 1 || across < 1 || radial < 1) throw MeshError("elements_per_cell must be at least 1 in every direction");
  if (along != across)
    throw MeshError(
        "elements_per_cell is [{}, {}, {}]; the cells of a file share no direction along the axis: make the first two "
        "equal",
        along, across, radial);
  const double total = static_cast<double>(mesh.cells.size()) * along * across * radial;
  if (total > static_cast<double>(largest_mesh_elements))
    throw MeshError("the mesh would have {:.0f} elements; at most {} are allowed", total, largest_mesh_elements);
}

void check_arrays(const HexahedralMesh& mesh) {
  const std::size_t count = mesh.cells.size();
  if (!mesh.apical_faces.empty() && mesh.apical_faces.size() != count)
    throw MeshError("{} apical faces are given for {} cells", mesh.apical_faces.size(), count);
  for (const int face : mesh.apical_faces)
    if (face < 0 || face > 5) throw MeshError("an apical face is {}; faces are 0 to 5", face);
  for (const auto& [name, values] : mesh.arrays)
    if (values.size() != count)
      throw MeshError("the cell array \"{}\" has {} values for {} cells", name, values.size(), count);
}

void check_cell_nodes(const HexahedralMesh& mesh, std::size_t cell) {
  std::array<NodeId, 8> nodes = mesh.cells[cell];
  for (const NodeId node : nodes) {
    if (!node.valid() || node.index() >= mesh.points.size())
      throw MeshError("cell {} uses node {}; nodes are 0 to {}", cell, node.number(),
                      static_cast<long long>(mesh.points.size()) - 1);
    const Vec3& point = mesh.points[node.index()];
    if (!point.allFinite() || point.cwiseAbs().maxCoeff() > largest_coordinate_um)
      throw MeshError("node {} of cell {} is at ({}, {}, {}); coordinates must be finite, in um", node.number(), cell,
                      point.x(), point.y(), point.z());
  }
  std::sort(nodes.begin(), nodes.end());
  const auto twice = std::adjacent_find(nodes.begin(), nodes.end());
  if (twice != nodes.end())
    throw MeshError("{} uses node {} twice; a hexahedron has eight", cell_at(mesh, cell), twice->number());
}

/// Remedy for a cell whose Jacobian is not positive at each corner.
const char* inversion_remedy(const HexPoints& p) {
  if (hex_scaled_jacobian({p[0], p[1], p[3], p[2], p[4], p[5], p[7], p[6]}) > 0)
    return "its nodes are in the order of a VTK_VOXEL; order them around each face (VTK_HEXAHEDRON)";
  if (hex_scaled_jacobian({p[4], p[5], p[6], p[7], p[0], p[1], p[2], p[3]}) > 0)
    return "it is turned over; order nodes 0-3 counter-clockwise seen from nodes 4-7";
  return "a corner is flat or folded in, or the order of the nodes is not VTK's";
}

void check_cells(const HexahedralMesh& mesh) {
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    check_cell_nodes(mesh, cell);
    const HexPoints points = gather(mesh.points, mesh.cells[cell]);
    if (!(hex_scaled_jacobian(points) > 0))
      throw MeshError("{} is inverted (det J <= 0 at a corner): {}", cell_at(mesh, cell), inversion_remedy(points));
  }
}

double mean_edge_length(const HexahedralMesh& mesh) {
  double sum = 0;
  for (const auto& cell : mesh.cells)
    for (const auto& [a, b] : hex_edges) sum += (mesh.points[cell[a].index()] - mesh.points[cell[b].index()]).norm();
  return sum / (12.0 * static_cast<double>(mesh.cells.size()));
}

/// Merges nodes of the surface in one place, so that cells that touch share them. Returns how many were merged.
std::ptrdiff_t merge_coincident_nodes(HexahedralMesh& mesh, const MeshFaces& faces) {
  std::vector<std::size_t> nodes;
  for (const CellFace& side : faces.surface())
    for (const int i : hex_faces[side.face]) nodes.push_back(mesh.cells[side.cell][i].index());
  const std::vector<std::size_t> first = first_in_place(mesh.points, std::move(nodes), 1e-6 * mean_edge_length(mesh));
  for (auto& cell : mesh.cells)
    for (NodeId& node : cell) node = NodeId(first[node.index()]);
  std::size_t number = 0;
  return std::ranges::count_if(first, [&](std::size_t one) { return one != number++; });
}

/// Gives the nodes of refined cells their numbers: what lies on a face or an edge is one node for all the cells there.
class LatticeNodes {
 public:
  LatticeNodes(Vectors& positions, const std::array<int, 3>& elements) : positions_(positions), elements_(elements) {}

  /// The node at a place of the lattice of a cell with these corners.
  NodeId node(const std::array<NodeId, 8>& corners, const std::array<int, 3>& place) {
    // Each corner's weight as a whole number (of along * across * radial). Corners of weight 0 are left out: a place on
    // a face or an edge has four or two, the same ones seen from each cell.
    Key key;
    std::size_t count = 0;
    for (int i = 0; i < 8; ++i) {
      int weight = 1;
      for (int axis = 0; axis < 3; ++axis)
        weight *= hex_reference_nodes[i][axis] > 0 ? place[axis] : elements_[axis] - place[axis];
      if (weight > 0) key[count++] = {corners[i].number(), weight};
    }
    if (count == 1) return NodeId(key[0].first);
    if (count == 8) return add(key);
    std::sort(key.begin(), key.end());
    const auto [entry, is_new] = shared_.try_emplace(key);
    if (is_new) entry->second = add(key);
    return entry->second;
  }

 private:
  using Key = std::array<std::pair<int, int>, 8>;  // node and weight; the rest 0
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::size_t hash = 1469598103934665603U;  // FNV-1a
      for (const auto& [node, weight] : key)
        for (const int value : {node, weight}) hash = (hash ^ static_cast<std::size_t>(value)) * 1099511628211U;
      return hash;
    }
  };

  NodeId add(const Key& key) {
    Vec3 sum = Vec3::Zero();
    const double total = static_cast<double>(elements_[0]) * elements_[1] * elements_[2];
    for (const auto& [node, weight] : key)
      if (weight > 0) sum += weight * positions_[static_cast<std::size_t>(node)];
    positions_.push_back(sum / total);
    return NodeId(positions_.size() - 1);
  }

  Vectors& positions_;
  std::array<int, 3> elements_;
  std::unordered_map<Key, NodeId, Hash> shared_;
};

/// Cells may be too warped to be cut up: det J is positive at their corners but not within.
void check_elements(const Tissue& tissue) {
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (!(hex_scaled_jacobian(tissue.element_rest_shape[e]) > 0))
      throw MeshError(
          "{} is so warped that its elements are inverted (det J <= 0 within it); move its corners, or lower "
          "elements_per_cell",
          cell_at(tissue, tissue.element_cell[e]));
}

Vec3 volume_centroid(const HexahedralMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const auto& cell : mesh.cells) {
    const HexPoints points = gather(mesh.points, cell);
    const double of_cell = hex_volume(points);
    for (const Vec3& point : points) sum += of_cell / 8 * point;
    volume += of_cell;
  }
  return sum / volume;
}

/// Keeps the largest piece, or remarks on several. Returns whether cells were dropped.
bool look_at_pieces(HexahedralMesh& mesh, const MeshFaces& faces, bool keep_largest) {
  const Pieces pieces = pieces_of(mesh.cells.size(), [&](std::size_t cell, const auto& take) {
    for (int face = 0; face < 6; ++face)
      if (const auto beyond = faces.neighbour({cell, face})) take(beyond->cell);
  });
  if (pieces.is_one()) return false;
  const std::string text = pieces.text("cells");
  if (!keep_largest) {
    if (mesh.apical_faces.empty())
      throw MeshError("the mesh is not one closed layer but {}: set embryo.keep = \"largest\"", text);
    mesh.remarks.push_back(
        fmt::format("the mesh has {} that share no face; embryo.keep = \"largest\" omits all but the largest", text));
    return false;
  }
  mesh.remarks.push_back(fmt::format("the largest of {} was kept", text));
  const std::size_t largest = pieces.largest();
  const auto keep = [&](auto& of_cells) {
    std::size_t kept = 0;
    for (std::size_t cell = 0; cell < of_cells.size(); ++cell)
      if (pieces.piece_of[cell] == largest) of_cells[kept++] = of_cells[cell];
    of_cells.resize(kept);
  };
  keep(mesh.cells);
  keep(mesh.apical_faces);
  for (auto& [name, values] : mesh.arrays) keep(values);
  return true;
}

}  // namespace

Tissue tissue_from_mesh(HexahedralMesh mesh, const MeshOptions& options) {
  const std::array<int, 3>& elements_per_cell = options.elements_per_cell;
  check_size(mesh, elements_per_cell);
  check_arrays(mesh);
  options.placement.turn(mesh.points);
  check_cells(mesh);
  const auto centre = [&] {
    if (options.placement.centre) move_to_origin(mesh.points, volume_centroid(mesh));
  };
  if (!mesh.groups.is_empty()) {
    if (elements_per_cell != std::array{1, 1, 1})
      throw MeshError(
          "elements_per_cell divides cells of one hexahedron; cells of this file already have several: omit it");
    if (options.keep_largest)
      throw MeshError("cells of several hexahedra cannot be selected by pieces: omit embryo.keep");
    centre();
    return tissue_from_groups(mesh);
  }
  MeshFaces faces(mesh.cells, mesh.points);
  if (const std::ptrdiff_t merged = merge_coincident_nodes(mesh, faces); merged > 0) {
    mesh.remarks.push_back(fmt::format("{} coincident nodes were merged", merged));
    check_cells(mesh);
    faces = MeshFaces(mesh.cells, mesh.points);
  }
  if (look_at_pieces(mesh, faces, options.keep_largest)) faces = MeshFaces(mesh.cells, mesh.points);
  centre();
  const std::vector<int> apical = mesh.apical_faces.empty() ? outer_faces(mesh, faces) : mesh.apical_faces;
  check_apical_faces(mesh, faces, apical);

  Vectors positions = mesh.points;
  LatticeNodes nodes(positions, elements_per_cell);
  std::vector<CellLattice> lattices(mesh.cells.size());
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const std::array<NodeId, 8> corners = turned_cell(mesh.cells[cell], apical[cell]);
    CellLattice& lattice = lattices[cell];
    lattice.elements = elements_per_cell;
    lattice.has_apical = faces.on_surface({cell, apical[cell]});
    lattice.has_basal = faces.on_surface({cell, opposite_face(apical[cell])});
    lattice.add_nodes([&](int u, int v, int w) { return nodes.node(corners, {u, v, w}); });
  }
  Tissue tissue = tissue_from_lattices(lattices, std::move(positions));
  drop_unused_nodes(tissue);
  check_elements(tissue);
  tissue.cell_arrays = std::move(mesh.arrays);
  tissue.remarks = std::move(mesh.remarks);
  return tissue;
}

Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array, const MeshOptions& options) {
  return of_file(file, [&] { return tissue_from_mesh(read_vtk_hexahedra(file, apical_array), options); });
}

}  // namespace plica
