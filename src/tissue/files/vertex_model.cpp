#include "tissue/files/vertex_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  std::vector<std::map<std::size_t, std::size_t>> next(
      tables.faces.index.size());  // of each face, from vertex to vertex
  for (std::size_t e = 0; e < from.size(); ++e)
    if (!next[face_rows.row(face[e])].emplace(vertex_rows.row(from[e]), vertex_rows.row(to[e])).second)
      throw MeshError(
          fmt::format("two edges of face {} begin at vertex {}; edges of a face must form one ring", face[e], from[e]));

  // tyssue leaves cells that have gone in its tables.
  const auto alive = tables.faces.columns.find("is_alive");
  const auto is_alive = [&](std::size_t f) { return alive == tables.faces.columns.end() || alive->second[f] != 0; };
  std::vector<std::size_t> kept;
  for (std::size_t f = 0; f < next.size(); ++f) {
    if (next[f].empty() || !is_alive(f)) continue;
    std::vector<std::size_t> ring = {next[f].begin()->first};
    for (auto step = next[f].begin(); ring.size() <= next[f].size() && step != next[f].end();
         step = next[f].find(step->second)) {
      if (step->second == ring.front()) break;
      ring.push_back(step->second);
    }
    const auto last = next[f].find(ring.back());
    if (ring.size() != next[f].size() || last == next[f].end() || last->second != ring.front())
      throw MeshError(
          fmt::format("the {} edges of face {} do not form one ring", next[f].size(), tables.faces.index[f]));
    file.surface.polygons.push_back(std::move(ring));
    kept.push_back(f);
  }
  for (const auto& [name, values] : tables.faces.columns) {
    CellArray& array = file.arrays[name];
    for (const std::size_t f : kept) array.push_back(values[f]);
  }
  return file;
}

}  // namespace plica
