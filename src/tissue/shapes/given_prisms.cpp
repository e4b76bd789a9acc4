#include "tissue/shapes/given_prisms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/extrusion.hpp"

namespace plica {
namespace {

std::string prism_at(const PrismSheet& sheet, std::size_t cell) {
  return fmt::format("cell {} at {}", cell, place_text(mean_corner(sheet.apical, sheet.cells[cell])));
}

void check_corners(const PrismSheet& sheet) {
  if (sheet.cells.empty()) throw MeshError("there are no cells");
  for (std::size_t cell = 0; cell < sheet.cells.size(); ++cell) {
    std::vector<std::size_t> corners = sheet.cells[cell];
    for (const std::size_t column : corners)
      if (!sheet.apical[column].allFinite() || !sheet.basal[column].allFinite())
        throw MeshError("a corner of cell {} is not finite; coordinates must be finite, in um", cell);
    std::ranges::sort(corners);
    if (corners.size() < 3 || std::ranges::adjacent_find(corners) != corners.end())
      throw MeshError("{} has {} corners; three or more different ones are required", prism_at(sheet, cell),
                      corners.size());
  }
}

// MeshError also if an edge has too many cells, or two that run alike.
void check_one_piece(const PrismSheet& sheet) {
  const auto neighbours = polygon_neighbours({sheet.apical, sheet.cells});
  const Pieces pieces = pieces_of(neighbours.size(), [&](std::size_t cell, const auto& take) {
    for (const std::size_t other : neighbours[cell])
      if (other != no_polygon) take(other);
  });
  if (pieces.is_one()) return;
  const auto apart = std::ranges::find_if(pieces.piece_of, [&](std::size_t one) { return one != pieces.largest(); });
  throw MeshError("the cells are not one piece but {}; {} shares no corners with the largest: join them, or omit it",
                  pieces.text("cells"), prism_at(sheet, static_cast<std::size_t>(apart - pieces.piece_of.begin())));
}

Vectors normals_of(const PolygonSurface& side) {
  Vectors normals;
  for (const auto& polygon : side.polygons) normals.push_back(area_vector(side.vertices, polygon).normalized());
  return normals;
}

// An edge that has no length on one side has the direction of the other.
std::vector<std::string> mend_side(Vectors& vertices, const PrismSheet& sheet, const PolygonOptions& options) {
  PolygonSurface side{vertices, sheet.cells};
  const std::vector<VertexBend> bends = vertex_bends(side);
  MendingRules rules;
  rules.normals = normals_of(side);
  rules.along = [&](const PolygonEdge& edge) {
    const auto [from, to] = edge.vertices;
    return Vec3((sheet.apical[to] - sheet.apical[from] + sheet.basal[to] - sheet.basal[from]).normalized());
  };
  rules.allowed = [&](std::size_t vertex, const Vec3& to) {
    const Vec3& normal = bends[vertex].normal;
    return Vec3(to - (to - vertices[vertex]).dot(normal) * normal);
  };
  std::vector<std::string> remarks = remarks_on(mend_polygons(rules, options, side));
  vertices = std::move(side.vertices);
  return remarks;
}

void check_polygons(const PrismSheet& sheet, bool mended) {
  for (const auto& [name, vertices] : {std::pair("apical", &sheet.apical), std::pair("basal", &sheet.basal)}) {
    const PolygonSurface side{*vertices, sheet.cells};
    const Vectors normals = normals_of(side);
    for (std::size_t cell = 0; cell < normals.size(); ++cell) {
      const auto& polygon = sheet.cells[cell];
      const Vec3 up = mean_corner(sheet.apical, polygon) - mean_corner(sheet.basal, polygon);
      if (!(up.dot(normals[cell]) > 0))
        throw MeshError(
            "the {} polygon of {} is wound the wrong way, or flat; order corners counter-clockwise seen from the "
            "apical side",
            name, prism_at(sheet, cell));
      if (const std::string flaw = polygon_flaw(*vertices, polygon, normals[cell]); !flaw.empty())
        throw MeshError("the {} polygon of {} {}; {}", name, prism_at(sheet, cell), flaw,
                        mended ? "move its corners" : "set mend = true, or move its corners");
    }
  }
}

bool is_closed(const PrismSheet& sheet) {
  return std::ranges::none_of(polygon_neighbours({sheet.apical, sheet.cells}),
                              [](const auto& across) { return std::ranges::count(across, no_polygon) > 0; });
}

}  // namespace

SurfaceTissue build_prisms(GivenPrisms given, const Placement& placement, bool mend, const PolygonCells& cells) {
  PrismSheet& sheet = given.sheet;
  check_corners(sheet);
  check_one_piece(sheet);
  for (Vectors* side : {&sheet.apical, &sheet.basal}) placement.turn(*side);
  if (placement.centre) {
    const auto sum = [](const Vectors& side) { return std::accumulate(side.begin(), side.end(), Vec3(0, 0, 0)); };
    const Vec3 centre = (sum(sheet.apical) + sum(sheet.basal)) / (2.0 * static_cast<double>(sheet.apical.size()));
    for (Vectors* side : {&sheet.apical, &sheet.basal}) move_to_origin(*side, centre);
  }
  if (mend) {
    const PrismSheet before = sheet;
    for (const auto& [name, side] : {std::pair("apical", &sheet.apical), std::pair("basal", &sheet.basal)})
      for (const std::string& remark : mend_side(*side, before, {.least_edge = cells.least_edge_ratio}))
        given.remarks.push_back(fmt::format("{} side: {}", name, remark));
  }
  check_polygons(sheet, mend);

  SurfaceTissue result;
  result.tissue = tissue_from_prisms(sheet, cells.split, cells.layers);
  const MeshQuality quality = mesh_quality(result.tissue, result.tissue.rest_positions);
  if (!(quality.min_scaled_jacobian > 0))
    throw MeshError("an element of {} is inverted; its apical and basal polygons are twisted, or too different: {}",
                    prism_at(sheet, quality.worst_cell.index()), mend ? "move its corners" : "set mend = true");
  result.tissue.cell_arrays = std::move(given.arrays);
  result.tissue.remarks = std::move(given.remarks);
  try {
    if (!is_closed(sheet)) throw MeshError("the layer of cells has a boundary; give a closed one");
    const PolygonSurface apical{sheet.apical, sheet.cells};
    result.tissue.outer_shape = shape_around(smooth_surface(apical), sheet.apical);
  } catch (const MeshError& error) {
    result.why_no_shape = error.what();
  }
  return result;
}

}  // namespace plica
