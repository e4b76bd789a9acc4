#include "tissue/shapes/surface_polygons.hpp"

#include <fmt/format.h>
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>

#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

constexpr std::size_t least_points = 12;
constexpr double same_place_um = 1e-6;
constexpr double widest_hole_cosine = 0.2;  // a triangle whose corners are further than that from its middle

std::string text_of(const Vec3& point) {
  return fmt::format("({:.4f}, {:.4f}, {:.4f}) um", point.x(), point.y(), point.z());
}

void check_points(const Vectors& points) {
  if (points.size() < least_points)
    throw MeshError("{} points; a closed sheet requires at least {} cells", points.size(), least_points);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite() || points[i].norm() < same_place_um)
      throw MeshError("row {} at {} is not a cell position; give three finite lengths in um, away from the origin", i,
                      text_of(points[i]));
  // Sorted along x, two points in one place are near each other in the list.
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points[i].x(); });
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a + 1; b < order.size() && points[order[b]].x() - points[order[a]].x() < same_place_um; ++b)
      if ((points[order[b]] - points[order[a]]).norm() < same_place_um)
        throw MeshError("rows {} and {} coincide at {}; give each cell its own position", std::min(order[a], order[b]),
                        std::max(order[a], order[b]), text_of(points[order[a]]));
}

// Qhull's memory, given back whatever happens.
struct Hull {
  qhT qh_space;

  Hull() { qh_zero(&qh_space, nullptr); }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;
  ~Hull() {
    qh_freeqhull(&qh_space, !qh_ALL);
    int memory = 0, total = 0;
    qh_memfreeshort(&qh_space, &memory, &total);
  }
};

// Facets of the convex hull of unit vectors, as triangles that look outward.
std::vector<std::array<std::size_t, 3>> hull_of(Vectors& directions) {
  const auto hull = std::make_unique<Hull>();
  qhT* const qh = &hull->qh_space;
  // Discard error output of Qhull, which would go to the terminal.
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> unheard(std::fopen("/dev/null", "w"), std::fclose);
  char command[] = "qhull Qt";
  const int status = qh_new_qhull(qh, 3, static_cast<int>(directions.size()), directions.front().data(), False, command,
                                  nullptr, unheard.get());
  if (status != 0)
    throw MeshError("the points have no convex hull (Qhull error {}); give points that surround the origin", status);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const facetT* facet = qh->facet_list; facet && facet->next; facet = facet->next) {
    std::array<std::size_t, 3> triangle{};
    for (int k = 0; k < 3; ++k)
      triangle[k] = static_cast<std::size_t>(qh_pointid(qh, static_cast<vertexT*>(facet->vertices->e[k].p)->point));
    const Vec3 &a = directions[triangle[0]], &b = directions[triangle[1]], &c = directions[triangle[2]];
    if (a.dot(b.cross(c)) < 0) std::swap(triangle[1], triangle[2]);
    triangles.push_back(triangle);
  }
  return triangles;
}

void check_triangles(const Vectors& points, const Vectors& directions,
                     const std::vector<std::array<std::size_t, 3>>& triangles) {
  for (const auto& [a, b, c] : triangles) {
    const Vec3 normal = (directions[b] - directions[a]).cross(directions[c] - directions[a]).normalized();
    if (normal.dot(directions[a]) < widest_hole_cosine)
      throw MeshError(
          "the rows {}, {} and {} are neighbours across a hole without points, at {}; points must surround the origin: "
          "shift them, or fill the hole",
          a, b, c, text_of((points[a] + points[b] + points[c]) / 3));
  }
  std::vector<bool> used(points.size(), false);
  for (const auto& triangle : triangles)
    for (const std::size_t point : triangle) used[point] = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used[i]) continue;
    std::size_t nearest = i == 0 ? 1 : 0;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i && directions[j].dot(directions[i]) > directions[nearest].dot(directions[i])) nearest = j;
    throw MeshError("rows {} and {} lie in one direction from the origin, at {} and {}; leave one cell per ray",
                    std::min(i, nearest), std::max(i, nearest), text_of(points[std::min(i, nearest)]),
                    text_of(points[std::max(i, nearest)]));
  }
  if (triangles.size() != 2 * points.size() - 4)
    throw MeshError("{} points make {} triangles, not {}; move points apart that nearly coincide", points.size(),
                    triangles.size(), 2 * points.size() - 4);
}

// The triangle beyond each side: sides sorted by their points come in twos.
std::vector<std::array<std::size_t, 3>> across_of(const std::vector<std::array<std::size_t, 3>>& triangles) {
  struct Side {
    std::size_t low, high, triangle, corner;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = triangles[t][(k + 1) % 3], b = triangles[t][(k + 2) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  std::ranges::stable_sort(sides, {}, [](const Side& side) { return std::pair(side.low, side.high); });
  std::vector<std::array<std::size_t, 3>> across(triangles.size());
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    if (sides[i].low != sides[i + 1].low || sides[i].high != sides[i + 1].high)
      throw MeshError("the triangles about rows {} and {} do not close; move points apart that nearly coincide",
                      sides[i].low, sides[i].high);
    across[sides[i].triangle][sides[i].corner] = sides[i + 1].triangle;
    across[sides[i + 1].triangle][sides[i + 1].corner] = sides[i].triangle;
  }
  return across;
}

std::size_t corner_opposite(const SurfaceTriangulation& t, std::size_t triangle, std::size_t neighbour) {
  for (std::size_t k = 0; k < 3; ++k)
    if (t.across[triangle][k] == neighbour) return k;
  return 0;
}

double cotangent(const Vec3& at, const Vec3& a, const Vec3& b) {
  return (a - at).dot(b - at) / (a - at).cross(b - at).norm();
}

bool is_outward(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)) > 0; }

// Whether a triangle about `point`, which is a corner of `start`, has the other point, too.
bool are_neighbours(const SurfaceTriangulation& t, std::size_t start, std::size_t point, std::size_t other) {
  std::size_t triangle = start;
  do {
    std::size_t corner = 0;
    while (t.triangles[triangle][corner] != point) ++corner;
    if (t.triangles[triangle][(corner + 1) % 3] == other) return true;
    triangle = t.across[triangle][(corner + 1) % 3];
  } while (triangle != start);
  return false;
}

// Turns the side opposite to a corner, if the angles ask for it and the result is a triangulation.
bool flip(const Vectors& points, SurfaceTriangulation& t, std::size_t first, std::size_t corner,
          std::size_t* neighbour) {
  const std::size_t second = t.across[first][corner];
  const std::size_t other = corner_opposite(t, second, first);
  const std::size_t a = t.triangles[first][corner], b = t.triangles[first][(corner + 1) % 3],
                    c = t.triangles[first][(corner + 2) % 3], d = t.triangles[second][other];
  // cot + cot < 0 is an angle sum of more than 180 degrees. Points on one circle stay as they are.
  if (cotangent(points[a], points[b], points[c]) + cotangent(points[d], points[b], points[c]) > -1e-9) return false;
  if (!is_outward(points[a], points[b], points[d]) || !is_outward(points[a], points[d], points[c])) return false;
  if (are_neighbours(t, first, a, d)) return false;

  const std::size_t beyond_ab = t.across[first][(corner + 2) % 3], beyond_ca = t.across[first][(corner + 1) % 3];
  // In `second` the corners are d, c, b.
  const std::size_t beyond_bd = t.across[second][(other + 1) % 3], beyond_dc = t.across[second][(other + 2) % 3];
  t.across[beyond_ca][corner_opposite(t, beyond_ca, first)] = second;
  t.across[beyond_bd][corner_opposite(t, beyond_bd, second)] = first;
  t.triangles[first] = {a, b, d};
  t.across[first] = {beyond_bd, second, beyond_ab};
  t.triangles[second] = {a, d, c};
  t.across[second] = {beyond_dc, beyond_ca, first};
  *neighbour = second;
  return true;
}

// The circumcentre of three points in their plane. That of a flat triangle is far away; it is brought back to within
// the longest side of the triangle's middle, where it still lies on the right side of its neighbours'.
Vec3 bounded_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = ab.cross(ac);
  Vec3 middle = (a + b + c) / 3;
  const Vec3 centre =
      a + (ab.squaredNorm() * ac.cross(normal) + ac.squaredNorm() * normal.cross(ab)) / (2 * normal.squaredNorm());
  const double longest = std::max({ab.norm(), ac.norm(), (c - b).norm()});
  const Vec3 away = centre - middle;
  if (!centre.allFinite()) return middle;
  return away.norm() > longest ? Vec3(middle + away * (longest / away.norm())) : centre;
}

Vectors points_on(const Vectors& points, const StarSurface& surface, double furthest_share) {
  Vectors on;
  on.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestOnSurface closest = surface.closest(points[i]);
    if (std::abs(closest.signed_distance_um) > furthest_share * closest.point.norm())
      throw MeshError(
          "row {} at ({:.4g}, {:.4g}, {:.4g}) um is {:.3g} um from the surface; move it within {:.0f} % of the radius",
          i, points[i].x(), points[i].y(), points[i].z(), closest.signed_distance_um, 100 * furthest_share);
    on.push_back(closest.point);
  }
  return on;
}

// The dual edge of a Delaunay triangulation is perpendicular to the line between its points, but on a bent surface a
// short one may run backwards a little.
MendedPolygons mend_about(const Vectors& points, const StarSurface& surface, const PolygonOptions& options,
                          PolygonSurface& polygons) {
  MendingRules rules;
  for (const Vec3& point : points) rules.normals.push_back(surface.bend(point).normal);
  rules.along = [&](const PolygonEdge& edge) {
    return Vec3(rules.normals[edge.left].cross(points[edge.right] - points[edge.left]).normalized());
  };
  rules.allowed = [&](std::size_t, const Vec3& to) { return surface.put_on(to); };
  return mend_polygons(rules, options, polygons);
}

// A number in [0, 1), the same with every standard library.
double next_number(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Few points are chosen among several candidates each, the furthest from those before: purely random ones may leave
// half of the surface bare.
constexpr std::size_t few_points = 500;
constexpr int candidates_of_few = 10;

// Random places, as many everywhere by area: rejection by the area of the surface over that of the unit sphere.
Vectors random_points(const StarSurface& surface, std::size_t count, std::uint64_t seed) {
  double largest = 0;
  for (const Vec3& direction : even_directions(2000)) largest = std::max(largest, surface.area_over(direction));
  largest *= 1.05;
  std::mt19937_64 random(seed);
  const auto next_point = [&] {
    while (true) {
      const double z = 2 * next_number(random) - 1, angle = 2 * std::numbers::pi * next_number(random);
      const double r = std::sqrt(1 - z * z);
      const Vec3 direction(r * std::cos(angle), r * std::sin(angle), z);
      if (next_number(random) * largest < surface.area_over(direction)) return surface.in_direction(direction);
    }
  };
  Vectors points;
  while (points.size() < count) {
    Vec3 best = next_point();
    double furthest = -1;
    for (int k = 0; count < few_points && k < candidates_of_few; ++k) {
      const Vec3 candidate = next_point();
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& point : points) nearest = std::min(nearest, (point - candidate).squaredNorm());
      if (nearest <= furthest) continue;
      furthest = nearest;
      best = candidate;
    }
    points.push_back(best);
  }
  return points;
}

}  // namespace

SurfaceTriangulation hull_triangulation(const Vectors& points, const StarSurface& surface) {
  check_points(points);
  Vectors directions;
  directions.reserve(points.size());
  for (const Vec3& point : points) directions.push_back(surface.scaled_direction(point));
  SurfaceTriangulation triangulation{hull_of(directions), {}};
  check_triangles(points, directions, triangulation.triangles);
  triangulation.across = across_of(triangulation.triangles);
  return triangulation;
}

std::size_t flip_to_delaunay(const Vectors& points, SurfaceTriangulation& triangulation) {
  // First in, first out; a flip puts its two triangles back.
  std::deque<std::size_t> waiting(triangulation.triangles.size());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  // Elongated shapes need about as many flips as there are points.
  const std::size_t most_flips = 100 * points.size() + 1000;
  std::size_t flips = 0;
  while (!waiting.empty()) {
    const std::size_t triangle = waiting.front();
    waiting.pop_front();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::size_t neighbour = 0;
      if (!flip(points, triangulation, triangle, corner, &neighbour)) continue;
      if (++flips > most_flips)
        throw MeshError(
            "neighbours about row {} at {} are ambiguous; give points on a smooth surface, denser than its bends",
            triangulation.triangles[triangle][0], text_of(points[triangulation.triangles[triangle][0]]));
      waiting.push_back(triangle);
      waiting.push_back(neighbour);
      break;
    }
  }
  return flips;
}

bool looks_outward(const Vectors& points, const SurfaceTriangulation& triangulation) {
  return std::ranges::all_of(triangulation.triangles, [&](const std::array<std::size_t, 3>& t) {
    return is_outward(points[t[0]], points[t[1]], points[t[2]]);
  });
}

std::vector<std::vector<std::size_t>> triangles_about(std::size_t point_count,
                                                      const SurfaceTriangulation& triangulation) {
  // Begin where the first side, from the point to the next corner, goes to the lowest neighbour.
  std::vector<std::size_t> first(point_count), lowest(point_count, static_cast<std::size_t>(-1));
  for (std::size_t t = 0; t < triangulation.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t point = triangulation.triangles[t][k], next = triangulation.triangles[t][(k + 1) % 3];
      if (next >= lowest[point]) continue;
      lowest[point] = next;
      first[point] = t;
    }
  std::vector<std::vector<std::size_t>> about(point_count);
  for (std::size_t point = 0; point < point_count; ++point) {
    std::size_t triangle = first[point];
    do {
      about[point].push_back(triangle);
      std::size_t corner = 0;
      while (triangulation.triangles[triangle][corner] != point) ++corner;
      // Counter-clockwise: across the side from the last corner back to the point.
      triangle = triangulation.across[triangle][(corner + 1) % 3];
    } while (triangle != first[point]);
  }
  return about;
}

PolygonSurface dual_polygons(const Vectors& points, const SurfaceTriangulation& triangulation,
                             const StarSurface& surface) {
  constexpr auto unnumbered = static_cast<std::size_t>(-1);
  PolygonSurface dual;
  dual.polygons = triangles_about(points.size(), triangulation);
  // Vertices are numbered as the polygons come, whatever order the triangles have.
  std::vector<std::size_t> number(triangulation.triangles.size(), unnumbered);
  for (auto& polygon : dual.polygons)
    for (std::size_t& vertex : polygon) {
      const std::size_t triangle = vertex;
      if (number[triangle] == unnumbered) {
        number[triangle] = dual.vertices.size();
        const auto& [a, b, c] = triangulation.triangles[triangle];
        dual.vertices.push_back(surface.put_on(bounded_circumcentre(points[a], points[b], points[c])));
      }
      vertex = number[triangle];
    }
  return dual;
}

void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons) {
  for (std::size_t p = 0; p < polygons.polygons.size(); ++p) {
    const std::string flaw = polygon_flaw(polygons.vertices, polygons.polygons[p], surface.bend(points[p]).normal);
    const Vec3& at = points[p];
    if (!flaw.empty())
      throw MeshError(
          "the cell of row {} at ({:.4g}, {:.4g}, {:.4g}) um {}; move its point away from its neighbours', or space "
          "these more evenly",
          p, at.x(), at.y(), at.z(), flaw);
  }
}

CellPolygons polygons_of_points(const Vectors& points, const StarSurface& surface, const PolygonOptions& options) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) throw MeshError("row {} is not a point; give three finite lengths in um", i);
  const Vectors on = points_on(points, surface, options.furthest_share);
  SurfaceTriangulation triangulation = hull_triangulation(on, surface);
  CellPolygons cells;
  cells.flipped_edges = flip_to_delaunay(on, triangulation);
  cells.surface = dual_polygons(on, triangulation, surface);
  static_cast<MendedPolygons&>(cells) = mend_about(on, surface, options, cells.surface);
  check_polygons(on, surface, cells.surface);
  return cells;
}

Vectors even_points(const StarSurface& surface, std::size_t count, std::uint64_t seed) {
  if (count < 12) throw MeshError("{} points; a closed sheet requires at least 12 cells", count);
  Vectors points = random_points(surface, count, seed);
  // Cells that are neighbours should be near each other in memory, too.
  std::ranges::sort(points, {}, [](const Vec3& p) { return p.x(); });
  SurfaceTriangulation triangulation = hull_triangulation(points, surface);
  for (int round = 0; round < Lloyd::rounds; ++round) {
    flip_to_delaunay(points, triangulation);
    const PolygonSurface cells = dual_polygons(points, triangulation, surface);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 middle = fan_about(cells.vertices, cells.polygons[i], points[i]).centroid;
      points[i] = surface.put_on(points[i] + Lloyd::share(round) * (middle - points[i]));
    }
    // The old neighbours are a start for the new ones, unless a triangle has turned over.
    if (!looks_outward(points, triangulation)) triangulation = hull_triangulation(points, surface);
  }
  return points;
}

}  // namespace plica
