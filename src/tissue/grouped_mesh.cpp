// Cells of several hexahedra out of a file: lattices on a grid, or prisms over polygons with nodes that may hang.
#include <algorithm>
#include <map>
#include <numeric>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/lattice.hpp"
#include "tissue/mesh_faces.hpp"
#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

constexpr double hanging_tolerance = 1e-6;  // of the distance of the two nodes, that a node may be from between them

/// The hexahedra cell by cell, each the right way up, and where each cell's begin; the end of the last behind them.
struct SortedHexahedra {
  std::vector<std::size_t> order;               // place in the file
  std::vector<std::array<NodeId, 8>> elements;  // in that order
  std::vector<std::size_t> first;               // cells
};

SortedHexahedra sorted_hexahedra(const HexahedralMesh& mesh) {
  const std::vector<int>& cell_of = mesh.groups.cell_of;
  if (cell_of.size() != mesh.cells.size())
    throw MeshError("cell_id has {} values for {} hexahedra", cell_of.size(), mesh.cells.size());
  SortedHexahedra sorted;
  sorted.order.resize(mesh.cells.size());
  std::iota(sorted.order.begin(), sorted.order.end(), std::size_t{0});
  std::ranges::stable_sort(sorted.order, {}, [&](std::size_t e) { return cell_of[e]; });
  for (std::size_t i = 0; i < sorted.order.size(); ++i) {
    const std::size_t e = sorted.order[i];
    if (i == 0 || cell_of[e] != cell_of[sorted.order[i - 1]]) sorted.first.push_back(i);
    sorted.elements.push_back(mesh.apical_faces.empty() ? mesh.cells[e]
                                                        : turned_cell(mesh.cells[e], mesh.apical_faces[e]));
  }
  sorted.first.push_back(sorted.order.size());
  return sorted;
}

// "cell 12 at (1.5, 0, -20) um": the middle of its first hexahedron.
std::string cell_at(const HexahedralMesh& mesh, const SortedHexahedra& sorted, std::size_t c) {
  return cell_text(c, mesh, sorted.elements[sorted.first[c]]);
}

// Reads a cell's lattice off its hexahedra, the first direction fastest.
CellLattice lattice_of(const HexahedralMesh& mesh, const SortedHexahedra& sorted, std::size_t c,
                       const std::array<int, 3>& elements) {
  CellLattice lattice;
  lattice.elements = elements;
  const auto [nu, nv, nw] = elements;
  const std::size_t begin = sorted.first[c], count = sorted.first[c + 1] - begin;
  if (std::ranges::any_of(elements, [](int n) { return n < 1 || n > 1000; }) ||
      static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv) * static_cast<std::size_t>(nw) != count)
    throw MeshError("{} has {} hexahedra; elements_per_cell is {} x {} x {}", cell_at(mesh, sorted, c), count, nu, nv,
                    nw);
  lattice.nodes.resize(static_cast<std::size_t>(nu + 1) * static_cast<std::size_t>(nv + 1) *
                       static_cast<std::size_t>(nw + 1));
  for (std::size_t e = 0; e < count; ++e) {
    const int in_cell = static_cast<int>(e), u = in_cell % nu, v = in_cell / nu % nv, w = in_cell / (nu * nv);
    for (int i = 0; i < 8; ++i) {
      const Vec3& r = hex_reference_nodes[i];
      const int place = (u + (r.x() > 0)) + (nu + 1) * ((v + (r.y() > 0)) + (nv + 1) * (w + (r.z() > 0)));
      NodeId& node = lattice.nodes[static_cast<std::size_t>(place)];
      if (node.valid() && node != sorted.elements[begin + e][i])
        throw MeshError("the hexahedra of {} do not form a grid of {} x {} x {} in order, first direction fastest",
                        cell_at(mesh, sorted, c), nu, nv, nw);
      node = sorted.elements[begin + e][i];
    }
  }
  return lattice;
}

Tissue from_grid(const HexahedralMesh& mesh, const SortedHexahedra& sorted, const MeshFaces& faces) {
  const std::vector<int>& counts = mesh.groups.elements_per_cell;
  const std::size_t cell_count = sorted.first.size() - 1;
  if (counts.size() != 3 * cell_count)
    throw MeshError("elements_per_cell has {} numbers for {} cells; give three per cell", counts.size(), cell_count);
  std::vector<CellLattice> lattices;
  for (std::size_t c = 0; c < cell_count; ++c) {
    lattices.push_back(lattice_of(mesh, sorted, c, {counts[3 * c], counts[3 * c + 1], counts[3 * c + 2]}));
    lattices.back().has_basal = faces.on_surface({sorted.first[c], 4});
    lattices.back().has_apical = faces.on_surface({sorted.first[c + 1] - 1, 5});
  }
  return tissue_from_lattices(lattices, mesh.points);
}

void set_hanging(const HexahedralMesh& mesh, Tissue& tissue) {
  const std::vector<int>& hanging = mesh.groups.hanging;
  std::size_t count = 0;
  for (std::size_t h = 0; h < hanging.size(); h += 1 + static_cast<std::size_t>(hanging[h]), ++count)
    if (hanging[h] == 1)
      throw MeshError(
          "the mesh is a periodic sheet, which cannot be read; use the keys of shape \"sheet\" that made it");
    else if (hanging[h] < 2 || static_cast<std::size_t>(hanging[h]) >= hanging.size() - h ||
             count >= mesh.points.size())
      throw MeshError(
          "hanging_nodes must give, for each of the last nodes of the mesh, how many nodes it lies between, and which");
  const std::size_t free = mesh.points.size() - count;
  std::size_t h = 0;
  for (std::size_t node = free; node < mesh.points.size(); ++node) {
    const int between = hanging[h++];
    NodeMean mean;
    double size = 0;
    for (int k = 0; k < between; ++k, ++h) {
      if (hanging[h] < 0 || static_cast<std::size_t>(hanging[h]) >= free)
        throw MeshError("node {} hangs on node {}, which is not free", node, hanging[h]);
      mean.emplace_back(NodeId(hanging[h]), 1.0 / between);
      size = std::max(size, (mesh.points[mean.back().first.index()] - mesh.points[mean[0].first.index()]).norm());
    }
    if (!((mean_of(mean, mesh.points) - mesh.points[node]).norm() <= hanging_tolerance * size))
      throw MeshError("node {} hangs on {} nodes, the first node {}, but does not lie in the middle between them", node,
                      between, mean[0].first.number());
    tissue.hanging.push_back(std::move(mean));
  }
}

void set_corners(const HexahedralMesh& mesh, const SortedHexahedra& sorted, std::size_t c, std::size_t& next,
                 std::size_t free, Cell& cell) {
  const int count = mesh.groups.corner_counts[c];
  if (count < 6 || count % 2 != 0 || static_cast<std::size_t>(count) > mesh.groups.corners.size() - next)
    throw MeshError("{} has {} corners; give 6 or more, equally many basal and apical", cell_at(mesh, sorted, c),
                    count);
  for (int k = 0; k < count; ++k) {
    const int corner = mesh.groups.corners[next++];
    if (corner < 0 || static_cast<std::size_t>(corner) >= free)
      throw MeshError("a corner of {} is node {}, which is not free", cell_at(mesh, sorted, c), corner);
    cell.corners.emplace_back(corner);
  }
}

// Adds the polygon of a cell whose elements are given. Basal nodes that hang are midway between two corners, or in the
// middle.
void add_polygon(const Tissue& tissue, const Cell& cell, const PolygonChains& chains, SheetOfColumns& sheet) {
  const std::map<NodeId, NodeId> above = nodes_above(tissue, cell);
  const auto column = [&](NodeId base) {
    SheetOfColumns::Column nodes = {base};
    for (auto next = above.find(base); next != above.end() && nodes.size() <= above.size();
         next = above.find(next->second))
      nodes.push_back(next->second);
    return nodes;
  };
  const std::span<const NodeId> corners = cell.basal_corners();
  const auto place_of = [&](NodeId node) -> OutlinePlace {
    if (node.is_among(tissue.free_node_count())) return sheet.place(column(node));
    const NodeMean& mean = tissue.hanging[node.index() - tissue.free_node_count()];
    for (std::size_t i = 0; i < corners.size() && mean.size() == 2; ++i)
      if (std::minmax(mean[0].first, mean[1].first) == std::minmax(corners[i], corners[(i + 1) % corners.size()]))
        return {static_cast<int>(i), 0.5};
    return {};
  };
  Polygon& polygon = sheet.add_cell();
  for (const auto& chain : chains.basal) {
    std::vector<SheetOfColumns::Column> stops;
    for (const NodeId node : std::span(chain).first(chain.size() - 1)) stops.push_back(column(node));
    sheet.add_side(stops);
  }
  const std::size_t levels = column(corners[0]).size() - 1,
                    count = static_cast<std::size_t>(cell.element_count) / levels;
  for (const auto& nodes : std::span(tissue.elements).subspan(cell.first_element.index(), count))
    polygon.quadrilaterals.push_back({place_of(nodes[0]), place_of(nodes[1]), place_of(nodes[2]), place_of(nodes[3])});
}

// Whether the mesh of the sheet would be the given one, with cells of kites where they have a node within.
bool is_mesh_of_sheet(const Tissue& tissue) {
  Tissue again = tissue;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Polygon& polygon = tissue.sheet.cells[c];
    const std::size_t begin = tissue.cells[c].first_element.index(),
                      count = static_cast<std::size_t>(tissue.cells[c].element_count);
    const bool hangs = std::ranges::any_of(std::span(tissue.elements).subspan(begin, count), [&](const auto& nodes) {
      return !std::ranges::all_of(nodes, [&](NodeId node) { return node.is_among(tissue.free_node_count()); });
    });
    if (polygon.inner.size() > (hangs ? 0 : 1) || element_count(tissue.sheet, CellId(c)) != count) return false;
    set_element_rest_shapes(again, CellId(c));
  }
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const HexPoints &one = tissue.element_rest_shape[e], &other = again.element_rest_shape[e];
    for (int i = 0; i < 8; ++i)
      if (!((one[i] - other[i]).norm() <= hanging_tolerance * (one[6] - one[0]).norm())) return false;
  }
  return true;
}

void add_cell(const HexahedralMesh& mesh, const SortedHexahedra& sorted, const MeshFaces& faces, std::size_t c,
              Cell cell, SheetOfColumns& sheet, Tissue& tissue) {
  const CellId id(c);
  const std::size_t begin = sorted.first[c], end = sorted.first[c + 1], basal = tissue.basal_facets.size(),
                    apical = tissue.apical_facets.size();
  cell.first_element = ElementId(begin);
  cell.element_count = static_cast<int>(end - begin);
  cell.lineage.id = tissue.next_cell_id++;
  for (std::size_t e = begin; e < end; ++e)
    add_element(sorted.elements[e], id, faces.on_surface({e, 4}), faces.on_surface({e, 5}), tissue);
  const auto chains = chains_about(tissue, std::span(tissue.basal_facets).subspan(basal),
                                   std::span(tissue.apical_facets).subspan(apical), cell);
  if (!chains)
    throw MeshError(
        "the corners of {} do not match its hexahedra; list in cell_corners those of its basal face, counter-clockwise "
        "seen from the apical side, then the apical ones above them; the first four nodes of each hexahedron are basal",
        cell_at(mesh, sorted, c));
  set_polygon_edges(*chains, tissue.rest_positions, cell);
  add_polygon(tissue, cell, *chains, sheet);
  for (const NodeId corner : cell.corners) cell.rest_shape.push_back(tissue.rest_positions[corner.index()]);
  tissue.cells.push_back(std::move(cell));
}

Tissue from_polygons(const HexahedralMesh& mesh, const SortedHexahedra& sorted, const MeshFaces& faces) {
  const std::size_t count = sorted.first.size() - 1;
  if (mesh.groups.corner_counts.size() != count)
    throw MeshError("cell_corner_counts has {} values for {} cells", mesh.groups.corner_counts.size(), count);
  Tissue tissue;
  tissue.rest_positions = mesh.points;
  set_hanging(mesh, tissue);
  SheetOfColumns sheet;
  std::size_t next = 0;
  for (std::size_t c = 0; c < count; ++c) {
    Cell cell;
    set_corners(mesh, sorted, c, next, tissue.free_node_count(), cell);
    add_cell(mesh, sorted, faces, c, std::move(cell), sheet, tissue);
  }
  if (next != mesh.groups.corners.size())
    throw MeshError("cell_corners has {} nodes; cell_corner_counts adds up to {}", mesh.groups.corners.size(), next);
  tissue.sheet = sheet.sheet();
  if (!is_mesh_of_sheet(tissue))
    for (Polygon& polygon : tissue.sheet.cells) polygon.quadrilaterals.clear();
  tissue.regions["all"] = CellSet(count, true);
  return tissue;
}

// Value common to all hexahedra of a cell, or else their mean.
CellArray of_cells(const CellArray& of_hexahedra, const SortedHexahedra& sorted) {
  CellArray values;
  for (std::size_t c = 0; c + 1 < sorted.first.size(); ++c) {
    const double first = of_hexahedra[sorted.order[sorted.first[c]]];
    double sum = 0;
    bool is_one = true;
    for (std::size_t i = sorted.first[c]; i < sorted.first[c + 1]; ++i) {
      sum += of_hexahedra[sorted.order[i]];
      is_one &= of_hexahedra[sorted.order[i]] == first;
    }
    values.push_back(is_one ? first : sum / static_cast<double>(sorted.first[c + 1] - sorted.first[c]));
  }
  return values;
}

}  // namespace

CellGroups groups_of(const Tissue& tissue) {
  CellGroups groups;
  const bool is_grid = std::ranges::all_of(tissue.cells, &Cell::is_of_grid);
  if (is_grid && tissue.elements.size() == tissue.cells.size()) return groups;
  for (const CellId cell : tissue.element_cell) groups.cell_of.push_back(cell.number());
  if (is_grid) {
    // As many as the edges' chains have: along hex_edges 0, 4 and 8.
    for (const Cell& cell : tissue.cells)
      for (const std::size_t edge : {0, 4, 8})
        groups.elements_per_cell.push_back(static_cast<int>(cell.edges[edge].nodes.size()) - 1);
    return groups;
  }
  for (const Cell& cell : tissue.cells) {
    groups.corner_counts.push_back(static_cast<int>(cell.corners.size()));
    for (const NodeId corner : cell.corners) groups.corners.push_back(corner.number());
  }
  for (const NodeMean& mean : tissue.hanging) {
    groups.hanging.push_back(static_cast<int>(mean.size()));
    for (const auto& [node, weight] : mean) groups.hanging.push_back(node.number());
  }
  return groups;
}

Tissue tissue_from_groups(const HexahedralMesh& mesh) {
  std::vector<char> is_used(mesh.points.size(), 0);
  for (const auto& cell : mesh.cells)
    for (const NodeId node : cell) is_used[node.index()] = 1;
  if (const auto unused = std::ranges::find(is_used, 0); unused != is_used.end())
    throw MeshError("node {} belongs to no hexahedron; remove it", unused - is_used.begin());
  const SortedHexahedra sorted = sorted_hexahedra(mesh);
  const MeshFaces faces(sorted.elements, mesh.points);
  Tissue tissue =
      mesh.groups.elements_per_cell.empty() ? from_polygons(mesh, sorted, faces) : from_grid(mesh, sorted, faces);
  for (const auto& [name, values] : mesh.arrays) tissue.cell_arrays[name] = of_cells(values, sorted);
  tissue.remarks = mesh.remarks;
  return tissue;
}

}  // namespace plica
