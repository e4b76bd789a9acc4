#include "tissue/files/vertex_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>

#include "core/names.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

const std::vector<double>& column(const NumberedTable& table, const char* name, const char* of) {
  const auto found = table.columns.find(name);
  if (found == table.columns.end())
    throw MeshError(fmt::format("the table of {} has no numeric column \"{}\"; it has {}", of, name,
                                fmt::join(keys_of(table.columns), ", ")));
  return found->second;
}

/// Rows by the numbers that name them.
class Rows {
 public:
  Rows(const NumberedTable& table, const char* of) : of_(of) {
    for (std::size_t row = 0; row < table.index.size(); ++row)
      if (!rows_.emplace(table.index[row], row).second)
        throw MeshError(fmt::format("the table of {} has two rows {}", of, table.index[row]));
  }

  [[nodiscard]] std::size_t row(double index) const {
    const auto found = rows_.find(index);
    if (found == rows_.end())
      throw MeshError(fmt::format("an edge names row {} of {}, which does not exist", index, of_));
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

}  // namespace

PolygonFile polygons_of(const VertexModelTables& tables) {
  PolygonFile file;
  const auto &x = column(tables.vertices, "x", "vertices"), &y = column(tables.vertices, "y", "vertices");
  const bool is_flat = !tables.vertices.columns.contains("z");
  for (std::size_t v = 0; v < x.size(); ++v)
    file.surface.vertices.emplace_back(x[v], y[v], is_flat ? 0 : tables.vertices.columns.at("z")[v]);

  const auto &from = column(tables.edges, "srce", "edges"), &to = column(tables.edges, "trgt", "edges"),
             &face = column(tables.edges, "face", "edges");
  const Rows vertex_rows(tables.vertices, "vertices"), face_rows(tables.faces, "faces");
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
      throw MeshError(
          fmt::format("the {} edges of face {} do not form one ring; correct them, or set is_alive of the face to 0",
                      edges[f].size(), tables.faces.index[f]));
    kept.push_back(f);
  }
  if (backwards > 0) file.remarks.push_back(fmt::format("{} half-edges that ran backwards were reversed", backwards));
  for (const auto& [name, values] : tables.faces.columns) {
    CellArray& array = file.arrays[name];
    for (const std::size_t f : kept) array.push_back(values[f]);
  }
  return file;
}

}  // namespace plica
