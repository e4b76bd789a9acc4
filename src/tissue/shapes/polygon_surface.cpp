#include "tissue/shapes/polygon_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

// One side of a polygon, to be matched with that of its neighbour.
struct PolygonSide {
  std::size_t low, high;  // vertices
  std::size_t polygon, place;
  bool rises;  // from low to high
};

std::vector<PolygonSide> sorted_sides(const PolygonSurface& surface) {
  std::vector<PolygonSide> sides;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t from = surface.periods.original(polygon[k]),
                        to = surface.periods.original(polygon[(k + 1) % polygon.size()]);
      sides.push_back({std::min(from, to), std::max(from, to), p, k, from < to});
    }
  }
  std::ranges::stable_sort(sides, {}, [](const PolygonSide& side) { return std::pair(side.low, side.high); });
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high) continue;
    const bool third = i + 2 < sides.size() && sides[i + 2].low == sides[i].low && sides[i + 2].high == sides[i].high;
    if (third || sides[i].rises == sides[i + 1].rises)
      throw MeshError(
          "the edge between vertices {} and {} at {} {}; each edge must belong to two cells that traverse it in "
          "opposite directions",
          sides[i].low, sides[i].high, place_text(surface.vertices[sides[i].low]),
          third ? "belongs to more than two cells" : "runs the same way in two cells");
    ++i;
  }
  return sides;
}

constexpr std::size_t most_passes = 60;
constexpr double overshoot = 1.02;  // of what is wanted, so that the passes come to an end

// Moves that the edges and angles of one pass ask for; they are added up, so their order does not matter.
class Moves {
 public:
  explicit Moves(const PolygonSurface& surface)
      : periods_(surface.periods), moves_(surface.vertices.size(), Vec3::Zero()) {}

  void add(std::size_t vertex, const Vec3& move) {
    moves_[periods_.original(vertex)] += move;
    any_ = true;
  }

  [[nodiscard]] bool any() const { return any_; }

  void apply(const MendingRules& rules, Vectors& vertices) const {
    for (std::size_t v = 0; v < vertices.size(); ++v)
      if (const Vec3& move = moves_[periods_.original(v)]; !move.isZero(0))
        vertices[v] = rules.allowed(v, vertices[v] + move);
  }

 private:
  const Periods& periods_;  // images move together
  Vectors moves_;
  bool any_ = false;
};

std::size_t lengthen_edges(const std::vector<PolygonEdge>& edges, const MendingRules& rules, double least_um,
                           const Vectors& vertices, Moves& moves) {
  std::size_t count = 0;
  for (const PolygonEdge& edge : edges) {
    const auto [from, to] = edge.vertices;
    const Vec3 direction = rules.along(edge);
    const double length = (vertices[to] - vertices[from]).dot(direction);
    if (length >= least_um) continue;
    ++count;
    const Vec3 half = 0.5 * (overshoot * least_um - length) * direction;
    moves.add(from, -half);
    moves.add(to, half);
  }
  return count;
}

std::size_t sharpen_corners(const PolygonSurface& surface, const Vectors& normals, double largest_deg, Moves& moves) {
  const double bend = (180 - largest_deg) * std::numbers::pi / 180;
  std::size_t count = 0;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    const std::vector<double> angles = polygon_angles_deg(surface.vertices, polygon, normals[p]);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      if (angles[k] <= largest_deg) continue;
      ++count;
      const Vec3& before = surface.vertices[polygon[(k + polygon.size() - 1) % polygon.size()]];
      const Vec3& at = surface.vertices[polygon[k]];
      const Vec3& after = surface.vertices[polygon[(k + 1) % polygon.size()]];
      // A corner at height h over the line between its neighbours bends by about h (1 / l1 + 1 / l2).
      const double l1 = (at - before).norm(), l2 = (after - at).norm();
      const Vec3 outward = (after - before).cross(normals[p]).normalized();
      const double height = (at - before).dot(outward), wanted = overshoot * bend * l1 * l2 / (l1 + l2);
      moves.add(polygon[k], std::max(0.0, wanted - height) * outward);
    }
  }
  return count;
}

double mean_length(const std::vector<PolygonEdge>& edges, const Vectors& vertices) {
  double sum = 0;
  for (const PolygonEdge& edge : edges) sum += (vertices[edge.vertices[1]] - vertices[edge.vertices[0]]).norm();
  return sum / static_cast<double>(edges.size());
}

}  // namespace

Vec3 mean_corner(const Vectors& vertices, const std::vector<std::size_t>& polygon) {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t vertex : polygon) sum += vertices[vertex];
  return sum / static_cast<double>(polygon.size());
}

Vec3 area_vector(const Vectors& vertices, const std::vector<std::size_t>& polygon) {
  const Vec3 centre = mean_corner(vertices, polygon);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    sum += (vertices[polygon[k]] - centre).cross(vertices[polygon[(k + 1) % polygon.size()]] - centre);
  return 0.5 * sum;
}

PolygonFan fan_about(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& centre) {
  PolygonFan fan{0, Vec3::Zero()};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& a = vertices[polygon[k]];
    const Vec3& b = vertices[polygon[(k + 1) % polygon.size()]];
    const double area = 0.5 * (a - centre).cross(b - centre).norm();
    fan.area += area;
    fan.centroid += area / 3 * (a + b + centre);
  }
  if (fan.area > 0)
    fan.centroid /= fan.area;
  else
    fan.centroid = centre;
  return fan;
}

std::vector<std::vector<std::size_t>> polygon_neighbours(const PolygonSurface& surface) {
  std::vector<std::vector<std::size_t>> neighbours;
  for (const auto& polygon : surface.polygons) neighbours.emplace_back(polygon.size(), no_polygon);
  const std::vector<PolygonSide> sides = sorted_sides(surface);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high) continue;
    neighbours[sides[i].polygon][sides[i].place] = sides[i + 1].polygon;
    neighbours[sides[i + 1].polygon][sides[i + 1].place] = sides[i].polygon;
  }
  return neighbours;
}

std::vector<PolygonEdge> polygon_edges(const PolygonSurface& surface) {
  const auto neighbours = polygon_neighbours(surface);
  std::vector<PolygonEdge> edges;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    for (std::size_t k = 0; k < polygon.size(); ++k)
      // The lower polygon tells of the edge; two may share several edges, and each tells of its own.
      if (neighbours[p][k] == no_polygon || p < neighbours[p][k])
        edges.push_back({{polygon[k], polygon[(k + 1) % polygon.size()]}, p, neighbours[p][k]});
  }
  return edges;
}

std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal) {
  std::vector<double> angles;
  angles.reserve(polygon.size());
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& at = vertices[polygon[k]];
    Vec3 in = at - vertices[polygon[(k + polygon.size() - 1) % polygon.size()]];
    Vec3 out = vertices[polygon[(k + 1) % polygon.size()]] - at;
    in -= in.dot(normal) * normal;
    out -= out.dot(normal) * normal;
    angles.push_back(180 - std::atan2(in.cross(out).dot(normal), in.dot(out)) * 180 / std::numbers::pi);
  }
  return angles;
}

MendedPolygons mend_polygons(const MendingRules& rules, const PolygonOptions& options, PolygonSurface& surface) {
  MendedPolygons mended;
  Vectors& vertices = surface.vertices;
  const Vectors start = vertices;
  const std::vector<PolygonEdge> edges = polygon_edges(surface);
  const double least_um = options.least_edge * mean_length(edges, vertices);
  for (;; ++mended.passes) {
    Moves moves(surface);
    mended.left_edges = lengthen_edges(edges, rules, least_um, vertices, moves);
    mended.left_corners = sharpen_corners(surface, rules.normals, options.largest_angle_deg, moves);
    if (mended.passes == 0) {
      mended.lengthened_edges = mended.left_edges;
      mended.sharpened_corners = mended.left_corners;
    }
    if (!moves.any() || mended.passes == most_passes) break;
    moves.apply(rules, vertices);
  }
  for (std::size_t v = 0; v < vertices.size(); ++v)
    mended.furthest_move_um = std::max(mended.furthest_move_um, (vertices[v] - start[v]).norm());
  return mended;
}

std::vector<std::string> remarks_on(const MendedPolygons& mended) {
  std::vector<std::string> remarks;
  if (mended.lengthened_edges + mended.sharpened_corners > 0)
    remarks.push_back(
        fmt::format("{} short edges and {} wide angles were repaired: their vertices moved by at most {:.2g} um",
                    mended.lengthened_edges, mended.sharpened_corners, mended.furthest_move_um));
  if (mended.left_edges + mended.left_corners > 0)
    remarks.push_back(fmt::format("{} edges remain short, and {} angles wide", mended.left_edges, mended.left_corners));
  return remarks;
}

std::string polygon_flaw(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& normal) {
  const std::vector<double> angles = polygon_angles_deg(vertices, polygon, normal);
  double turn = 0;
  for (const double angle : angles) turn += 180 - angle;
  const double widest = *std::ranges::max_element(angles);
  // Convex at every corner and once around: it cannot cross itself.
  if (!(std::abs(turn - 360) < 1) || polygon.size() < 3) return "crosses itself, or has a side without length";
  return widest < 179 ? "" : fmt::format("is not convex, with a corner of {:.0f} degrees", widest);
}

}  // namespace plica
