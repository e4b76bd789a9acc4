#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/names.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

const std::vector<double>& column(const NumberedTable& table, const char* name, const char* of) {
  const auto found = table.columns.find(name);
  if (found == table.columns.end())
    throw MeshError("the table of {} has no numeric column \"{}\"; it has {}", of, name,
                    fmt::join(keys_of(table.columns), ", "));
  return found->second;
}

/// Rows by the numbers that name them.
class RowsByNumber {
 public:
  RowsByNumber(const NumberedTable& table, const char* of) : of_(of) {
    for (std::size_t row = 0; row < table.index.size(); ++row)
      if (!rows_.emplace(table.index[row], row).second)
        throw MeshError("the table of {} has two rows {}", of, table.index[row]);
  }

  [[nodiscard]] std::size_t row(double index) const {
    const auto found = rows_.find(index);
    if (found == rows_.end()) throw MeshError("an edge names row {} of {}, which does not exist", index, of_);
    return found->second;
  }

 private:
  const char* of_;
  std::unordered_map<double, std::size_t> rows_;
};

struct HalfEdge {
  std::size_t from, to;
};

// The corners of a face, in the direction of most of its edges. Counts those that run the other way; empty if they do
// not form one ring.
std::vector<std::size_t> ring_of(const std::vector<HalfEdge>& edges, std::size_t& backwards) {
  std::map<std::size_t, std::vector<std::size_t>> edges_at;  // vertices
  for (std::size_t e = 0; e < edges.size(); ++e) {
    edges_at[edges[e].from].push_back(e);
    edges_at[edges[e].to].push_back(e);
  }
  if (edges_at.size() != edges.size() || edges_at.begin()->second.size() != 2) return {};
  std::vector<std::size_t> ring;
  std::size_t along = 0, edge = 0, at = edges[0].from;
  do {
    if (edges_at[at].size() != 2) return {};
    ring.push_back(at);
    const bool is_along = edges[edge].from == at;
    along += is_along ? 1 : 0;
    at = is_along ? edges[edge].to : edges[edge].from;
    const auto& both = edges_at[at];
    edge = both[0] == edge ? both[1] : both[0];
  } while (edge != 0 && ring.size() < edges.size());
  if (edge != 0 || ring.size() != edges.size()) return {};
  if (2 * along < ring.size()) std::ranges::reverse(ring);
  std::rotate(ring.begin(), std::ranges::min_element(ring), ring.end());
  backwards += std::min(along, ring.size() - along);
  return ring;
}

using Edge = std::pair<std::size_t, std::size_t>;

template <class Take>
void for_sides(const std::vector<std::size_t>& polygon, const Take& take) {
  for (std::size_t k = 0; k < polygon.size(); ++k) take(polygon[k], polygon[(k + 1) % polygon.size()]);
}

// Faces by label; 0 for none.
std::map<double, std::vector<std::size_t>> faces_by_label(const PolygonFile& file, const CellArray& labels) {
  std::map<double, std::vector<std::size_t>> faces;
  for (std::size_t f = 0; f < file.surface.polygons.size(); ++f) faces[labels[f] > 0 ? labels[f] : 0].push_back(f);
  return faces;
}

// For each vertex, how many cells meet there; the outside counts as one.
std::vector<std::size_t> meeting_cells(const PolygonSurface& surface, const CellArray& labels) {
  std::vector<std::set<double>> meeting(surface.vertices.size());
  std::map<Edge, int> uses;
  for (std::size_t f = 0; f < surface.polygons.size(); ++f)
    for_sides(surface.polygons[f], [&](std::size_t from, std::size_t to) {
      meeting[from].insert(labels[f] > 0 ? labels[f] : 0);
      ++uses[std::minmax(from, to)];
    });
  for (const auto& [edge, count] : uses)
    if (count == 1)
      for (const std::size_t vertex : {edge.first, edge.second}) meeting[vertex].insert(0);
  std::vector<std::size_t> counts;
  for (const auto& cells : meeting) counts.push_back(cells.size());
  return counts;
}

std::vector<std::size_t> outline_of(const PolygonSurface& surface, double label,
                                    const std::vector<std::size_t>& faces) {
  std::map<Edge, int> uses;
  for (const std::size_t f : faces)
    for_sides(surface.polygons[f], [&](std::size_t from, std::size_t to) { ++uses[std::minmax(from, to)]; });
  std::map<std::size_t, std::vector<std::size_t>> beside;
  for (const auto& [edge, count] : uses) {
    if (count != 1) continue;
    beside[edge.first].push_back(edge.second);
    beside[edge.second].push_back(edge.first);
  }
  std::vector<std::size_t> ring;
  if (!beside.empty()) {
    std::size_t before = beside.begin()->first, at = before;
    do {
      if (beside[at].size() != 2) break;
      ring.push_back(at);
      const std::size_t next = beside[at][0] == before ? beside[at][1] : beside[at][0];
      before = std::exchange(at, next);
    } while (at != ring.front());
  }
  if (ring.size() != beside.size() || ring.empty())
    throw MeshError("the faces with label {} are in pieces, or enclose others; correct the labels near {}", label,
                    place_text(surface.vertices[surface.polygons[faces.front()].front()]));
  return ring;
}

// As most of its faces run.
void wind_like(const PolygonSurface& surface, const std::vector<std::size_t>& faces, std::vector<std::size_t>& ring) {
  Vec3 normal = Vec3::Zero();
  for (const std::size_t f : faces) normal += area_vector(surface.vertices, surface.polygons[f]);
  if (area_vector(surface.vertices, ring).dot(normal) < 0) std::ranges::reverse(ring);
}

}  // namespace

PolygonFile polygons_of(const VertexModelTables& tables) {
  PolygonFile file;
  const auto &x = column(tables.vertices, "x", "vertices"), &y = column(tables.vertices, "y", "vertices");
  const bool is_flat = !tables.vertices.columns.contains("z");
  for (std::size_t v = 0; v < x.size(); ++v)
    file.surface.vertices.emplace_back(x[v], y[v], is_flat ? 0 : tables.vertices.columns.at("z")[v]);

  const auto &from = column(tables.edges, "srce", "edges"), &to = column(tables.edges, "trgt", "edges"),
             &face = column(tables.edges, "face", "edges");
  const RowsByNumber vertex_rows(tables.vertices, "vertices"), face_rows(tables.faces, "faces");
  std::vector<std::vector<HalfEdge>> edges(tables.faces.index.size());
  for (std::size_t e = 0; e < from.size(); ++e)
    edges[face_rows.row(face[e])].push_back({vertex_rows.row(from[e]), vertex_rows.row(to[e])});

  // tyssue leaves cells that have gone in its tables.
  const auto alive = tables.faces.columns.find("is_alive");
  const auto is_alive = [&](std::size_t f) { return alive == tables.faces.columns.end() || alive->second[f] != 0; };
  std::vector<std::size_t> kept;
  std::size_t backwards = 0;
  for (std::size_t f = 0; f < edges.size(); ++f) {
    if (edges[f].empty() || !is_alive(f)) continue;
    file.surface.polygons.push_back(ring_of(edges[f], backwards));
    if (file.surface.polygons.back().empty())
      throw MeshError("the {} edges of face {} do not form one ring; correct them, or set is_alive of the face to 0",
                      edges[f].size(), tables.faces.index[f]);
    kept.push_back(f);
  }
  if (backwards > 0) file.remarks.push_back(fmt::format("{} half-edges that ran backwards were reversed", backwards));
  for (const auto& [name, values] : tables.faces.columns) {
    CellArray& array = file.arrays[name];
    for (const std::size_t f : kept) array.push_back(values[f]);
  }
  return file;
}

PolygonFile cells_of_labels(const PolygonFile& file, const std::string& label_array) {
  const auto found = file.arrays.find(label_array);
  if (found == file.arrays.end())
    throw MeshError("no array \"{}\" of its faces; there {}", label_array,
                    file.arrays.empty() ? "are none" : fmt::format("are: {}", fmt::join(keys_of(file.arrays), ", ")));
  const CellArray& labels = found->second;
  const std::vector<std::size_t> meeting = meeting_cells(file.surface, labels);
  PolygonFile cells;
  cells.surface.vertices = file.surface.vertices;
  cells.remarks = file.remarks;
  std::size_t omitted = 0;
  for (const auto& [label, faces] : faces_by_label(file, labels)) {
    if (label == 0) continue;
    std::vector<std::size_t> ring = outline_of(file.surface, label, faces);
    wind_like(file.surface, faces, ring);
    std::erase_if(ring, [&](std::size_t vertex) { return meeting[vertex] < 3; });
    if (ring.size() < 3) {
      ++omitted;
      continue;
    }
    cells.surface.polygons.push_back(std::move(ring));
    for (const auto& [name, values] : file.arrays) {
      double sum = 0;
      for (const std::size_t f : faces) sum += values[f];
      cells.arrays[name].push_back(sum / static_cast<double>(faces.size()));
    }
  }
  if (cells.surface.polygons.empty())
    throw MeshError("no label of \"{}\" has faces with three corners where three cells meet", label_array);
  if (omitted > 0) cells.remarks.push_back(fmt::format("{} cells with fewer than three corners were omitted", omitted));
  return cells;
}

std::string label_advice(const PolygonFile& file) {
  const auto& polygons = file.surface.polygons;
  if (!std::ranges::all_of(polygons, [](const auto& polygon) { return polygon.size() == 3; })) return "";
  for (const auto& [name, values] : file.arrays) {
    const std::set<double> different(values.begin(), values.end());
    const bool are_whole = std::ranges::all_of(values, [](double value) { return value == std::floor(value); });
    if (name.find("label") != std::string::npos && are_whole && 2 * different.size() <= values.size())
      return fmt::format(
          "its {} faces are triangles with {} values of \"{}\"; if these number the cells, set embryo.label_array = "
          "\"{}\"",
          polygons.size(), different.size(), name, name);
  }
  return "";
}

}  // namespace plica
