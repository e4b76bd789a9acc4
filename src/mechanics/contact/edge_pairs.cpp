#include "mechanics/contact/edge_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/box_grid.hpp"

namespace plica {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Summary of the pairs of the previous step near a node of the side.
struct Memory {
  double least_gap = infinite;       // um, now
  double edge_distance = -infinite;  // um: the largest that a pair of edges has
};

class Memories {
 public:
  Memories(std::span<const ContactPair> known, std::span<const Vec3> positions, const Mirror& mirror)
      : mirror_(mirror), of_nodes_(positions.size()) {
    for (const ContactPair& pair : known) {
      const double gap = pair.gap(positions);
      for (const SurfacePlace* place : {&pair.p, &pair.q})
        for (const NodeId node : place->all_nodes()) {
          Memory& memory = of_nodes_[mirror.image(node).node.index()];
          memory.least_gap = std::min(memory.least_gap, gap);
          if (pair.is_of_edges()) memory.edge_distance = std::max(memory.edge_distance, pair.distance);
        }
    }
  }
  [[nodiscard]] Memory of(const Segment& segment) const {
    Memory result;
    for (int i = 0; i < segment.count; ++i) {
      const Memory& memory = of_nodes_[mirror_.image(segment.nodes[i]).node.index()];
      result.least_gap = std::min(result.least_gap, memory.least_gap);
      result.edge_distance = std::max(result.edge_distance, memory.edge_distance);
    }
    return result;
  }

 private:
  const Mirror& mirror_;
  std::vector<Memory> of_nodes_;
};

bool are_neighbours(const Segment& a, const Segment& b) {
  for (int i = 0; i < a.count; ++i)
    for (int k = 0; k < b.count; ++k)
      if (a.nodes[i] == b.nodes[k]) return true;
  const auto ends_on = [](const Segment& one, const Segment& other) {
    return std::any_of(one.nodes.begin(), one.nodes.begin() + one.count,
                       [&](NodeId node) { return other.lying.contains(node); });
  };
  if (ends_on(a, b) || ends_on(b, a)) return true;
  for (const std::size_t of_a : a.triangles)
    for (const std::size_t of_b : b.triangles)
      if (of_a / 4 == of_b / 4) return true;
  return false;
}

/// A segment that is looked at: where it lies, and the way out of its triangles.
struct Placed {
  std::size_t segment;
  Vec3 from, to, outward;
  Box box;
};

std::vector<Placed> placed(const std::vector<Segment>& segments, const EdgePairs::Surface& surface,
                           const Mirror& mirror, const std::vector<char>& is_searched) {
  const auto end_of = [&](const Segment& segment) { return segment.at(1).at(surface.positions); };
  const auto is_near = [&](const Segment& segment) {
    return std::any_of(segment.nodes.begin(), segment.nodes.begin() + segment.count,
                       [&](NodeId node) { return is_searched[mirror.image(node).node.index()]; });
  };
  std::vector<Placed> result;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Segment& segment = segments[s];
    if (!is_near(segment)) continue;
    const Vec3& from = surface.positions[segment.nodes[0].index()];
    const Vec3 to = end_of(segment);
    const auto& [one, other] = segment.triangles;
    Box box{from, from};
    box.take(to);
    result.push_back({s, from, to, (surface.triangle_areas[one] + surface.triangle_areas[other]).normalized(), box});
  }
  return result;
}

class Search {
 public:
  Search(const std::vector<Segment>& segments, std::span<const Vec3> positions, double distance,
         std::span<const ContactPair> known, const Mirror& mirror)
      : segments_(segments),
        positions_(positions),
        distance_(distance),
        known_(std::ranges::partition_point(known, [](const ContactPair& pair) { return !pair.is_of_edges(); }),
               known.end()),
        memories_(known, positions, mirror) {}

  [[nodiscard]] double reach() const { return 4 * distance_; }

  [[nodiscard]] std::optional<ContactPair> pair_of(const Placed& a, const Placed& b) const {
    const Segment &of_a = segments_[a.segment], &of_b = segments_[b.segment];
    if (of_a.area == 0 && of_b.area == 0) return std::nullopt;  // images: a pair of the side's stands for them
    const std::optional<PlacesOnSegments> places = nearest_inside(a.from, a.to, b.from, b.to);
    if (!places) return std::nullopt;
    ContactPair pair{static_cast<double>(a.segment), static_cast<double>(b.segment), of_a.at(places->on_first),
                     of_b.at(places->on_second), (a.to - a.from).cross(b.to - b.from).normalized()};
    if (pair.apart(positions_).squaredNorm() >= reach() * reach() || are_neighbours(of_a, of_b)) return std::nullopt;
    const ContactPair* last = last_of(pair);
    if (!turn(pair, last, b.outward - a.outward)) return std::nullopt;
    pair.first_gap = pair.gap(positions_);
    // Penetration is admissible only where both were in contact, and then by one distance more than the last pair.
    const Memory memory_a = memories_.of(of_a), memory_b = memories_.of(of_b);
    const double last_gap = std::max(memory_a.least_gap, memory_b.least_gap);
    if (pair.first_gap < (last_gap < distance_ ? std::min(0.0, last_gap) - distance_ : 0)) return std::nullopt;
    // A pair that slides in from a neighbouring segment keeps the distance at which that one pushed.
    const double seen_at = last ? last->distance : std::min(memory_a.edge_distance, memory_b.edge_distance);
    pair.distance = std::min(distance_ / 2, std::max({seen_at, pair.first_gap, 0.0}));
    pair.area = EdgePairs::stiffening * (of_a.area + of_b.area) / 2;
    return pair;
  }

 private:
  [[nodiscard]] const ContactPair* last_of(const ContactPair& pair) const {
    const auto segments = [](const ContactPair& one) { return std::pair(one.first, one.second); };
    const auto found = std::ranges::lower_bound(known_, segments(pair), {}, segments);
    return found != known_.end() && segments(*found) == segments(pair) ? &*found : nullptr;
  }

  /// Turn the normal towards the first segment: as in the previous step, or by the facing directions of both. False if
  /// neither decides.
  static bool turn(ContactPair& pair, const ContactPair* last, const Vec3& facing) {
    constexpr double least_as_before = 0.5, least_as_facing = 0.2;  // cosines
    double to_first = last ? pair.normal.dot(last->normal) : 0;
    if (std::abs(to_first) < least_as_before) {
      to_first = pair.normal.dot(facing.normalized());
      if (std::abs(to_first) < least_as_facing) return false;
    }
    if (to_first < 0) pair.normal = -pair.normal;
    return true;
  }

  const std::vector<Segment>& segments_;
  std::span<const Vec3> positions_;
  double distance_;
  std::span<const ContactPair> known_;  // of edges
  Memories memories_;
};

}  // namespace

// By the region of the plane that p lies over (Ericson, Real-Time Collision Detection, 5.1.5).
ClosestPoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  std::array<double, 3> w;
  if (d1 <= 0 && d2 <= 0) {
    w = {1, 0, 0};
  } else if (d3 >= 0 && d4 <= d3) {
    w = {0, 1, 0};
  } else if (d6 >= 0 && d5 <= d6) {
    w = {0, 0, 1};
  } else if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {  // an edge without length is a corner's business
    const double v = d1 / (d1 - d3);
    w = {1 - v, v, 0};
  } else if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    const double v = d2 / (d2 - d6);
    w = {1 - v, 0, v};
  } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double v = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    w = {0, 1 - v, v};
  } else {
    const double sum = va + vb + vc;
    w = {va / sum, vb / sum, vc / sum};
  }
  return {w, (p - w[0] * a - w[1] * b - w[2] * c).squaredNorm()};
}

std::optional<PlacesOnSegments> nearest_inside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // Ends are left to pairs of points: rounding does not determine on which side of an end a place lies.
  constexpr double least_sine = 1e-3, least_part = 1e-9;
  const Vec3 u = b - a, v = d - c, w = c - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > least_sine * least_sine * uu * vv)) return std::nullopt;
  // Parameters at which the connection between the lines a + s u and c + t v is perpendicular to both.
  const double s = (uw * vv - uv * vw) / determinant, t = (uw * uv - uu * vw) / determinant;
  const auto is_inside = [](double part) { return part > least_part && part < 1 - least_part; };
  if (!is_inside(s) || !is_inside(t)) return std::nullopt;
  return PlacesOnSegments{s, t};
}

SurfacePlace Segment::at(double part) const {
  if (count == 2) return {nodes, 2, {1 - part, part}};
  return {nodes, 4, {1 - 0.75 * part, 0.25 * part, 0.25 * part, 0.25 * part}};
}

EdgePairs::EdgePairs(std::span<const std::array<NodeId, 4>> facets, std::span<const double> areas,
                     const std::map<std::pair<NodeId, NodeId>, std::set<NodeId>>& lying) {
  // A facet's triangles have a quarter of its area each, and three segments.
  std::map<std::pair<NodeId, NodeId>, std::size_t> edges;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (std::size_t i = 0; i < 4; ++i) {
      const NodeId from = facets[f][i], to = facets[f][(i + 1) % 4];
      const std::size_t triangle = 4 * f + i, before = 4 * f + (i + 3) % 4;
      segments_.push_back(
          {{from, to, facets[f][(i + 2) % 4], facets[f][(i + 3) % 4]}, 4, {before, triangle}, areas[f] / 6});
      const auto [known, is_new] = edges.try_emplace(std::minmax(from, to), segments_.size());
      if (is_new) {
        segments_.push_back({{from, to}, 2, {triangle, triangle}, areas[f] / 12});
        if (const auto found = lying.find(std::minmax(from, to)); found != lying.end())
          segments_.back().lying = found->second;
      } else {
        segments_[known->second].triangles[1] = triangle;
        segments_[known->second].area += areas[f] / 12;
      }
    }
}

std::vector<ContactPair> EdgePairs::find(const Surface& surface, double distance, const Mirror& mirror,
                                         std::span<const ContactPair> known,
                                         const std::vector<char>& is_searched) const {
  const std::vector<Placed> all = placed(segments_, surface, mirror, is_searched);
  const Search search(segments_, surface.positions, distance, known, mirror);
  double longest = 0;
  for (const Placed& one : all) longest = std::max(longest, (one.to - one.from).norm());
  std::vector<Box> boxes;
  Vectors outward;  // apart from the rest: most segments are only asked where they look
  for (const Placed& one : all) boxes.push_back(one.box), outward.push_back(one.outward);
  const BoxGrid grid(std::max(search.reach(), 0.5 * longest), std::move(boxes));
  std::vector<ContactPair> pairs;
  std::vector<std::uint32_t> candidates;
  for (std::size_t i = 0; i < all.size(); ++i) {
    constexpr double rounded = -1e-9;  // of a cosine: what is square to each other on one side is so on its image
    const auto is_facing = [&](std::uint32_t k) { return all[i].outward.dot(outward[k]) <= rounded; };
    grid.find_overlapping(all[i].box.widened(search.reach()), candidates, i + 1, is_facing);
    for (const std::uint32_t k : candidates)
      if (const std::optional<ContactPair> pair = search.pair_of(all[i], all[k])) pairs.push_back(*pair);
  }
  return pairs;
}

}  // namespace plica
