#include "tissue/files/labelled_faces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/names.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/place.hpp"

namespace plica {
namespace {

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

// The outline of the faces of one label.
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
    throw MeshError(fmt::format("the faces with label {} are in pieces, or enclose others; correct the labels near {}",
                                label, place_text(surface.vertices[surface.polygons[faces.front()].front()])));
  return ring;
}

// As most of its faces run.
void wind_like(const PolygonSurface& surface, const std::vector<std::size_t>& faces, std::vector<std::size_t>& ring) {
  Vec3 normal = Vec3::Zero();
  for (const std::size_t f : faces) normal += area_vector(surface.vertices, surface.polygons[f]);
  if (area_vector(surface.vertices, ring).dot(normal) < 0) std::ranges::reverse(ring);
}

}  // namespace

PolygonFile cells_of_labels(const PolygonFile& file, const std::string& label_array) {
  const auto found = file.arrays.find(label_array);
  if (found == file.arrays.end())
    throw MeshError(
        fmt::format("no array \"{}\" of its faces; there {}", label_array,
                    file.arrays.empty() ? "are none" : fmt::format("are: {}", fmt::join(keys_of(file.arrays), ", "))));
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
    throw MeshError(fmt::format("no label of \"{}\" has faces with three corners where three cells meet", label_array));
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
          "its {} faces are triangles with {} values of \"{}\"; if these number the cells, set "
          "embryo.label_array = \"{}\"",
          polygons.size(), different.size(), name, name);
  }
  return "";
}

}  // namespace plica
