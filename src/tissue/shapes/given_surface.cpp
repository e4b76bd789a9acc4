#include "tissue/shapes/given_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "tissue/mesh_input.hpp"
#include "tissue/shapes/extrusion.hpp"

namespace plica {
namespace {

constexpr double largest_coordinate_um = 1e9;
constexpr double same_place = 1e-4;            // of the mean edge: five digits in a text
constexpr double sharpest_fold_cosine = -0.9;  // of the angle between two neighbours' normals
constexpr double deepest_rim_angle_deg = 220;  // to which a corner of one face may go in to be no corner
constexpr double farthest_move = 0.4;          // of the mean edge, by which mending may move a vertex

std::string face_at(const PolygonSurface& surface, std::size_t face) {
  return fmt::format("face {} at {}", face, place_text(mean_corner(surface.vertices, surface.polygons[face])));
}

void check_corners(const PolygonSurface& surface) {
  if (surface.polygons.empty()) throw MeshError("the surface has no faces");
  for (std::size_t face = 0; face < surface.polygons.size(); ++face) {
    std::vector<std::size_t> corners = surface.polygons[face];
    if (corners.size() < 3)
      throw MeshError("face {} has {} corners; a cell requires at least three: remove the face, or correct it", face,
                      corners.size());
    for (const std::size_t vertex : corners) {
      const Vec3& p = surface.vertices[vertex];
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > largest_coordinate_um)
        throw MeshError("vertex {} of face {} is at ({}, {}, {}); coordinates must be finite, in um", vertex, face,
                        p.x(), p.y(), p.z());
    }
    std::ranges::sort(corners);
    if (const auto twice = std::ranges::adjacent_find(corners); twice != corners.end())
      throw MeshError("{} has vertex {} twice, at {}", face_at(surface, face), *twice,
                      place_text(surface.vertices[*twice]));
  }
}

// Corners that repeat the one before: rings that are closed twice, edges whose ends were merged.
std::size_t drop_repeated_corners(PolygonSurface& surface) {
  std::size_t dropped = 0;
  for (auto& polygon : surface.polygons) {
    const std::size_t before = polygon.size();
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    dropped += before - polygon.size();
  }
  return dropped;
}

double mean_side(const PolygonSurface& surface) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto& polygon : surface.polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k, ++count)
      sum += (surface.vertices[polygon[(k + 1) % polygon.size()]] - surface.vertices[polygon[k]]).norm();
  return sum / static_cast<double>(count);
}

// Neighbours share vertices after that.
std::size_t merge_vertices(PolygonSurface& surface, bool mend) {
  std::vector<std::size_t> used;
  for (const auto& polygon : surface.polygons) used.insert(used.end(), polygon.begin(), polygon.end());
  const std::vector<std::size_t> first =
      first_in_place(surface.vertices, std::move(used), same_place * mean_side(surface));
  std::size_t merged = 0;
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (first[v] == v) continue;
    ++merged;
    if (!mend)
      throw MeshError("vertices {} and {} coincide at {}; let neighbours share their vertices: set mend = true",
                      first[v], v, place_text(surface.vertices[v]));
  }
  for (auto& polygon : surface.polygons)
    for (std::size_t& vertex : polygon) vertex = first[vertex];
  return merged;
}

// Returns how many there were that are not `merged`.
std::size_t drop_unused(PolygonSurface& surface, std::size_t merged) {
  constexpr auto unused = static_cast<std::size_t>(-1);
  std::vector<std::size_t> now(surface.vertices.size(), unused);
  for (const auto& polygon : surface.polygons)
    for (const std::size_t vertex : polygon) now[vertex] = 0;
  Vectors kept;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (now[v] == unused) continue;
    now[v] = kept.size();
    kept.push_back(surface.vertices[v]);
  }
  for (auto& polygon : surface.polygons)
    for (std::size_t& vertex : polygon) vertex = now[vertex];
  const std::size_t dropped = surface.vertices.size() - kept.size() - merged;
  surface.vertices = std::move(kept);
  return dropped;
}

/// Face beyond an edge; `runs_alike` if both have the edge in the same direction, which is an error of orientation.
struct FaceAcross {
  std::size_t face;
  bool runs_alike;
};

// Faces across the edges of each face; none across a rim.
std::vector<std::vector<FaceAcross>> faces_across(const PolygonSurface& surface) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::pair<std::size_t, bool>>> faces;  // and if it rises
  for (std::size_t face = 0; face < surface.polygons.size(); ++face) {
    const auto& polygon = surface.polygons[face];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t from = polygon[k], to = polygon[(k + 1) % polygon.size()];
      faces[std::minmax(from, to)].emplace_back(face, from < to);
    }
  }
  std::vector<std::vector<FaceAcross>> across(surface.polygons.size());
  for (const auto& [edge, at] : faces) {
    if (at.size() > 2)
      throw MeshError("the edge from {} to {} belongs to {} faces, {}, {} and {} among them; an edge may belong to two",
                      place_text(surface.vertices[edge.first]), place_text(surface.vertices[edge.second]), at.size(),
                      at[0].first, at[1].first, at[2].first);
    if (at.size() < 2) continue;
    const bool alike = at[0].second == at[1].second;
    across[at[0].first].push_back({at[1].first, alike});
    across[at[1].first].push_back({at[0].first, alike});
  }
  return across;
}

// Keeps the largest piece, or MeshError when there are several. Returns the faces that stay.
std::vector<std::size_t> keep_one_piece(PolygonSurface& surface, bool keep_largest, std::vector<std::string>& remarks) {
  const auto across = faces_across(surface);
  const Pieces pieces = pieces_of(across.size(), [&](std::size_t face, const auto& take) {
    for (const FaceAcross& other : across[face]) take(other.face);
  });
  std::vector<std::size_t> kept(surface.polygons.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  if (pieces.is_one()) return kept;
  const std::size_t largest = pieces.largest();
  std::erase_if(kept, [&](std::size_t face) { return pieces.piece_of[face] != largest; });
  if (!keep_largest) {
    const auto apart = static_cast<std::size_t>(
        std::ranges::find_if(pieces.piece_of, [&](std::size_t piece) { return piece != largest; }) -
        pieces.piece_of.begin());
    throw MeshError(
        "the surface is not one piece but {}; {} is joined to the largest by no edge: set embryo.keep = \"largest\", "
        "or join them (corners of neighbours may lie at most {:.2g} um apart)",
        pieces.text("cells"), face_at(surface, apart), same_place * mean_side(surface));
  }
  remarks.push_back(fmt::format("the largest of {} was kept", pieces.text("cells")));
  std::vector<std::vector<std::size_t>> polygons;
  for (const std::size_t face : kept) polygons.push_back(std::move(surface.polygons[face]));
  surface.polygons = std::move(polygons);
  return kept;
}

// Faces to reverse so that all wind like the first, to which all are joined. MeshError when that cannot be.
std::vector<bool> unlike_first(const PolygonSurface& surface) {
  const auto across = faces_across(surface);
  std::vector<int> turn(surface.polygons.size(), -1);
  std::vector<std::size_t> reached = {0};
  turn[0] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const FaceAcross& other : across[reached[i]]) {
      const int wanted = turn[reached[i]] ^ static_cast<int>(other.runs_alike);
      if (turn[other.face] == 1 - wanted)
        throw MeshError("{} and face {} cannot both face outward: the surface is one-sided",
                        face_at(surface, reached[i]), other.face);
      if (turn[other.face] == wanted) continue;
      turn[other.face] = wanted;
      reached.push_back(other.face);
    }
  return {turn.begin(), turn.end()};
}

// All look outward: of a closed surface, the volume inside is positive; of an open one, most stay as they are.
std::size_t turn_faces(PolygonSurface& surface, bool mend, bool& is_closed) {
  std::vector<bool> turned = unlike_first(surface);
  const auto turn = [&](std::size_t face) { std::ranges::reverse(surface.polygons[face]); };
  std::size_t count = static_cast<std::size_t>(std::ranges::count(turned, true));
  if (2 * count > turned.size()) {
    turned.flip();
    count = turned.size() - count;
  }
  for (std::size_t face = 0; face < turned.size(); ++face)
    if (turned[face]) turn(face);
  const std::vector<PolygonEdge> edges = polygon_edges(surface);
  is_closed = std::ranges::none_of(edges, [](const PolygonEdge& edge) { return edge.right == no_polygon; });
  double volume = 0;
  for (std::size_t face = 0; face < turned.size(); ++face)
    volume += mean_corner(surface.vertices, surface.polygons[face])
                  .dot(area_vector(surface.vertices, surface.polygons[face]));
  if (is_closed && volume < 0) {
    for (std::size_t face = 0; face < turned.size(); ++face) turn(face);
    turned.flip();
    count = turned.size() - count;
  }
  if (count > 0 && !mend)
    throw MeshError(
        "{} is wound the wrong way, as are {} of {} faces; order corners counter-clockwise seen from outside, or set "
        "mend = true",
        face_at(surface, static_cast<std::size_t>(std::ranges::find(turned, true) - turned.begin())), count,
        turned.size());
  return count;
}

// Remark for an open surface, whose intended side is ambiguous.
std::string apical_side_text(const PolygonSurface& surface) {
  Vec3 sum = Vec3::Zero();
  for (const auto& polygon : surface.polygons) sum += area_vector(surface.vertices, polygon);
  const Vec3 way = sum.normalized();
  return fmt::format(
      ", by majority: the apical side faces ({:.2f}, {:.2f}, {:.2f}); for the other side, reverse most faces of the "
      "file",
      way.x(), way.y(), way.z());
}

// The faces about a vertex should follow each other across its edges: one fan.
void check_fans(const PolygonSurface& surface) {
  struct Corner {
    std::size_t before, after, face;
  };
  std::vector<std::vector<Corner>> corners(surface.vertices.size());
  for (std::size_t face = 0; face < surface.polygons.size(); ++face) {
    const auto& polygon = surface.polygons[face];
    const std::size_t n = polygon.size();
    for (std::size_t k = 0; k < n; ++k)
      corners[polygon[k]].push_back({polygon[(k + n - 1) % n], polygon[(k + 1) % n], face});
  }
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const auto& about = corners[v];
    // From the face at the rim, if there is one, counter-clockwise.
    std::size_t start = 0;
    for (std::size_t i = 0; i < about.size(); ++i)
      if (std::ranges::none_of(about, [&](const Corner& other) { return other.before == about[i].after; })) start = i;
    std::size_t reached = 1;
    for (std::size_t at = start; reached <= about.size(); ++reached) {
      const auto next = std::ranges::find(about, about[at].before, &Corner::after);
      if (next == about.end() || next == about.begin() + static_cast<std::ptrdiff_t>(start)) break;
      at = static_cast<std::size_t>(next - about.begin());
    }
    if (reached == about.size()) continue;
    throw MeshError(
        "the surface touches itself at vertex {} at {}: face {} and others meet there but share no edge with the rest",
        v, place_text(surface.vertices[v]), about.front().face);
  }
}

void check_areas(const PolygonSurface& surface) {
  const double least = 1e-9 * std::pow(mean_side(surface), 2);
  for (std::size_t face = 0; face < surface.polygons.size(); ++face)
    if (!(area_vector(surface.vertices, surface.polygons[face]).norm() > least))
      throw MeshError(face_at(surface, face) + " has no area");
}

// Vertices along a wall between two cells, which cannot be convex on both sides, and along a rim where it is straight
// or bent inward a little. A face keeps three corners.
std::size_t drop_wall_vertices(PolygonSurface& surface, double largest_angle_deg) {
  std::vector<std::set<std::size_t>> neighbours(surface.vertices.size());
  std::vector<std::size_t> face_count(surface.vertices.size(), 0);
  std::vector<double> angle_deg(surface.vertices.size(), 0.0);  // of one face there
  for (const auto& polygon : surface.polygons) {
    const std::vector<double> angles =
        polygon_angles_deg(surface.vertices, polygon, area_vector(surface.vertices, polygon).normalized());
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t next = polygon[(k + 1) % polygon.size()];
      neighbours[polygon[k]].insert(next);
      neighbours[next].insert(polygon[k]);
      ++face_count[polygon[k]];
      angle_deg[polygon[k]] = angles[k];
    }
  }
  std::vector<char> goes(surface.vertices.size(), 0);
  for (std::size_t v = 0; v < goes.size(); ++v)
    goes[v] = neighbours[v].size() == 2 &&
              (face_count[v] == 2 || (angle_deg[v] > largest_angle_deg && angle_deg[v] < deepest_rim_angle_deg));
  for (const auto& polygon : surface.polygons)
    for (std::size_t k = 0, left = polygon.size() - static_cast<std::size_t>(std::ranges::count_if(
                                                        polygon, [&](std::size_t v) { return goes[v] != 0; }));
         left < 3 && k < polygon.size(); ++k)
      if (std::exchange(goes[polygon[k]], 0) != 0) ++left;
  for (auto& polygon : surface.polygons) std::erase_if(polygon, [&](std::size_t v) { return goes[v] != 0; });
  return drop_unused(surface, 0);
}

// Neighbours face nearly the same way, or at least not against each other.
void check_folds(const PolygonSurface& surface) {
  Vectors normals;
  for (const auto& polygon : surface.polygons) normals.push_back(area_vector(surface.vertices, polygon).normalized());
  for (const PolygonEdge& edge : polygon_edges(surface)) {
    if (edge.right == no_polygon || normals[edge.left].dot(normals[edge.right]) > sharpest_fold_cosine) continue;
    throw MeshError(
        "{} and its neighbour, face {}, are folded onto each other at the edge from {} to {}; if the sheet is "
        "periodic, omit the faces that cross its boundary",
        face_at(surface, edge.left), edge.right, place_text(surface.vertices[edge.vertices[0]]),
        place_text(surface.vertices[edge.vertices[1]]));
  }
}

double warp_deg(const PolygonSurface& surface, std::size_t face) {
  const auto& polygon = surface.polygons[face];
  const Vec3 middle = mean_corner(surface.vertices, polygon),
             normal = area_vector(surface.vertices, polygon).normalized();
  double least = 1;
  for (std::size_t k = 0; polygon.size() > 3 && k < polygon.size(); ++k) {
    const Vec3 one = (surface.vertices[polygon[k]] - middle)
                         .cross(surface.vertices[polygon[(k + 1) % polygon.size()]] - middle)
                         .normalized();
    least = std::min(least, one.dot(normal));
  }
  return std::acos(std::clamp(least, -1.0, 1.0)) * 180 / std::numbers::pi;
}

void check_faces(const PolygonSurface& surface, bool mended) {
  check_areas(surface);
  for (std::size_t face = 0; face < surface.polygons.size(); ++face) {
    const auto& polygon = surface.polygons[face];
    const std::string flaw =
        polygon_flaw(surface.vertices, polygon, area_vector(surface.vertices, polygon).normalized());
    if (!flaw.empty())
      throw MeshError("{} {}{}; split it, or move its corners", face_at(surface, face), flaw,
                      mended ? "" : " (mend = true sharpens wide angles)");
    const double warp = warp_deg(surface, face);
    if (warp > largest_warp_deg)
      throw MeshError("{} is far from flat: its corners lie up to {:.0f} degrees out of its plane; {} are allowed",
                      face_at(surface, face), warp, largest_warp_deg);
  }
}

// Vertices move within the surface's tangent planes.
MendedPolygons mend_shapes(PolygonSurface& surface, const PolygonOptions& options) {
  const Vectors start = surface.vertices;
  const std::vector<VertexBend> bends = vertex_bends(surface);
  MendingRules rules;
  for (const auto& polygon : surface.polygons)
    rules.normals.push_back(area_vector(surface.vertices, polygon).normalized());
  rules.along = [&](const PolygonEdge& edge) {
    return Vec3((start[edge.vertices[1]] - start[edge.vertices[0]]).normalized());
  };
  rules.allowed = [&](std::size_t vertex, const Vec3& to) {
    const Vec3& normal = bends[vertex].normal;
    return Vec3(to - (to - start[vertex]).dot(normal) * normal);
  };
  const double limit_um = farthest_move * mean_side(surface);
  const MendedPolygons mended = mend_polygons(rules, options, surface);
  for (std::size_t v = 0; v < start.size(); ++v) {
    if ((surface.vertices[v] - start[v]).norm() <= limit_um) continue;
    surface.vertices = start;
    check_faces(surface, true);  // a face is wrong, as a rule
    throw MeshError(
        "its short edges and wide angles cannot be repaired: vertex {} at {} would move by more than {:.3g} um; set "
        "mend = false, or lower least_edge_ratio",
        v, place_text(start[v]), limit_um);
  }
  return mended;
}

}  // namespace

MendedSurface check_and_mend(PolygonSurface& surface, bool mend, const PolygonOptions& options, bool keep_largest) {
  MendedSurface result;
  const auto remark = [&](std::size_t count, const char* what) {
    if (count > 0) result.remarks.push_back(fmt::format("{} {}", count, what));
  };
  std::size_t repeated = drop_repeated_corners(surface);
  check_corners(surface);
  const std::size_t merged = merge_vertices(surface, mend);
  remark(merged, "coincident vertices were merged");
  repeated += drop_repeated_corners(surface);
  remark(repeated, "corners in the place of the one before them were removed");
  check_corners(surface);
  remark(drop_unused(surface, merged), "unused vertices were removed");
  result.kept = keep_one_piece(surface, keep_largest, result.remarks);
  drop_unused(surface, 0);
  const std::size_t turned = turn_faces(surface, mend, result.is_closed);
  remark(turned, "faces were reversed");
  if (turned > 0 && !result.is_closed) result.remarks.back() += apical_side_text(surface);
  check_fans(surface);
  check_areas(surface);
  check_folds(surface);
  if (mend) {
    remark(drop_wall_vertices(surface, options.largest_angle_deg),
           "vertices along an edge or the rim, where no third cell meets, were removed");
    check_areas(surface);
    const std::vector<std::string> shapes = remarks_on(mend_shapes(surface, options));
    result.remarks.insert(result.remarks.end(), shapes.begin(), shapes.end());
  }
  check_faces(surface, mend);
  return result;
}

}  // namespace plica
