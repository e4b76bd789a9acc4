#include "mechanics/contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "mechanics/contact/closest_point.hpp"
#include "mechanics/coulomb.hpp"

namespace plica {
namespace {

using Pair = SelfContact::Pair;

/// An internal state is the revision of the pattern, then these numbers a pair: point, nodes, weights, normal,
/// distance, first gap.
constexpr std::size_t pair_size = 14;

Pair unpacked(std::span<const double> numbers) {
  Pair pair{static_cast<std::size_t>(numbers[0]),       {},          {numbers[5], numbers[6], numbers[7], numbers[8]},
            Vec3(numbers[9], numbers[10], numbers[11]), numbers[12], numbers[13]};
  for (int k = 0; k < 4; ++k) pair.nodes[k] = NodeId(static_cast<std::size_t>(numbers[1 + k]));
  return pair;
}

/// Which triangles are near a place: a grid of cubes, each of which lists those whose box, widened, touches it.
class Grid {
 public:
  Grid(double size, double widening) : size_(size), widening_(widening) {}

  void add(std::size_t triangle, const std::array<Vec3, 3>& corners) {
    const Vec3 low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - widening_;
    const Vec3 high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + widening_;
    const auto from = cube(low), to = cube(high);
    for (long i = from[0]; i <= to[0]; ++i)
      for (long j = from[1]; j <= to[1]; ++j)
        for (long k = from[2]; k <= to[2]; ++k) triangles_[key({i, j, k})].push_back(triangle);
  }
  [[nodiscard]] std::span<const std::size_t> near(const Vec3& place) const {
    const auto found = triangles_.find(key(cube(place)));
    return found == triangles_.end() ? std::span<const std::size_t>{} : std::span<const std::size_t>(found->second);
  }

 private:
  using Cube = std::array<long, 3>;
  [[nodiscard]] Cube cube(const Vec3& place) const {
    return {std::lround(std::floor(place.x() / size_)), std::lround(std::floor(place.y() / size_)),
            std::lround(std::floor(place.z() / size_))};
  }
  // 21 bits a direction: two cubes of one key are a million cubes apart, and then too far to be a pair anyway.
  [[nodiscard]] static std::uint64_t key(const Cube& cube) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    std::uint64_t result = 0;
    for (const long i : cube) result = (result << 21) | (static_cast<std::uint64_t>(i) & mask);
    return result;
  }

  double size_, widening_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> triangles_;
};

Vec3 area_vector(const std::array<NodeId, 4>& facet, std::span<const Vec3> x) {
  return facet_area_vector({x[facet[0].index()], x[facet[1].index()], x[facet[2].index()], x[facet[3].index()]});
}

struct Triangle {
  std::array<Vec3, 3> corners;
  Vec3 area;  // twice its area vector
};

// Four a facet, from its edges to the mean of its corners.
std::vector<Triangle> triangles_of(const std::vector<std::array<NodeId, 4>>& facets, std::span<const Vec3> x) {
  std::vector<Triangle> triangles;
  triangles.reserve(4 * facets.size());
  for (const auto& facet : facets) {
    Vec3 middle = Vec3::Zero();
    for (const NodeId node : facet) middle += x[node.index()] / 4;
    for (std::size_t edge = 0; edge < 4; ++edge) {
      const Vec3 &a = x[facet[edge].index()], &b = x[facet[(edge + 1) % 4].index()];
      triangles.push_back({{a, b, middle}, (b - a).cross(middle - a)});
    }
  }
  return triangles;
}

}  // namespace

SelfContact::SelfContact(const Tissue& whole, const SelfContactRule& rule, Mirror mirror)
    : rule_(rule), mirror_(std::move(mirror)) {
  std::map<NodeId, std::vector<std::size_t>> of_node;
  std::map<NodeId, double> area_of_node;
  std::vector<double> areas;  // 0 of images, whose points are not this side's
  for (const Facet& facet : rule.side == CellSide::apical ? whole.apical_facets : whole.basal_facets) {
    const bool is_own = mirror_.own(facet.cell) == facet.cell;
    areas.push_back(is_own ? facet_area(rest_corners(whole, facet)) : 0);
    for (const NodeId node : facet.nodes) {
      of_node[node].push_back(facets_.size());
      area_of_node[node] += areas.back() / 16;
    }
    facets_.push_back(facet.nodes);
  }
  std::map<std::pair<NodeId, NodeId>, std::size_t> edges;
  for (std::size_t f = 0; f < facets_.size(); ++f)
    for (int i = 0; i < 4; ++i) edges[{facets_[f][i], facets_[f][(i + 1) % 4]}] = f;
  for (const auto& [edge, facet] : edges)
    if (!edges.contains({edge.second, edge.first})) rim_.push_back({edge.first, edge.second, facet});
  const auto add_mean = [&](const std::array<NodeId, 4>& nodes, int count, double area) {
    if (area == 0) return;
    points_.push_back({nodes, count, area});
    std::vector<std::size_t> around;
    for (int i = 0; i < count; ++i) around.insert(around.end(), of_node[nodes[i]].begin(), of_node[nodes[i]].end());
    std::ranges::sort(around);
    around.erase(std::unique(around.begin(), around.end()), around.end());
    neighbours_.push_back(std::move(around));
  };
  for (const auto& [node, facets] : of_node) {
    if (area_of_node[node] == 0) continue;
    points_.push_back({{node}, 1, area_of_node[node]});
    neighbours_.push_back(facets);
  }
  for (std::size_t f = 0; f < facets_.size(); ++f) add_mean(facets_[f], 4, areas[f] / 4);
  for (const auto& [edge, facet] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    const bool on_rim = other == edges.end();
    if (!on_rim && edge.second < edge.first) continue;
    add_mean({edge.first, edge.second}, 2, (areas[facet] + (on_rim ? 0 : areas[other->second])) / 8);
  }
}

std::vector<Pair> SelfContact::pairs(std::span<const Vec3> positions, std::span<const double> known) const {
  const Vectors of_whole = mirror_.is_used() ? mirror_.whole(positions) : Vectors();
  const std::span<const Vec3> x = mirror_.is_used() ? std::span<const Vec3>(of_whole) : positions;
  // Normals of nodes and of points, by the area vectors of their facets.
  Vectors normals(x.size(), Vec3::Zero()), outward(x.size(), Vec3::Zero());
  double longest = 0;
  for (const auto& facet : facets_) {
    const Vec3 area = area_vector(facet, x);
    for (const NodeId node : facet) normals[node.index()] += area;
    for (const int i : {0, 1}) longest = std::max(longest, (x[facet[i + 2].index()] - x[facet[i].index()]).norm());
  }
  // Of nodes on the rim of an open surface: the way out of it.
  for (const auto& [from, to, facet] : rim_) {
    const Vec3 out = (x[to.index()] - x[from.index()]).cross(area_vector(facets_[facet], x)).normalized();
    outward[from.index()] += out;
    outward[to.index()] += out;
  }
  Grid grid(std::max(rule_.search, 0.5 * longest), rule_.search);
  const std::vector<Triangle> triangles = triangles_of(facets_, x);
  for (std::size_t t = 0; t < triangles.size(); ++t) grid.add(t, triangles[t].corners);
  const std::vector<Pair> before = pairs_of(known);
  auto last = before.begin();  // that of the point or of one after it
  std::vector<Pair> pairs;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    while (last != before.end() && last->point < p) ++last;
    const bool was_seen = last != before.end() && last->point == p;
    // How far it may be inside: where it touched, a distance more than its last pair shows, which lags.
    const double last_gap = was_seen ? last->gap(points_[p], x) : std::numeric_limits<double>::infinity();
    const double least_gap = last_gap < rule_.distance ? std::min(0.0, last_gap) - rule_.distance : 0;
    const Vec3 place = points_[p].at(x), facing = points_[p].at(normals);
    double nearest2 = rule_.search * rule_.search;
    std::optional<Pair> best;
    for (const std::size_t t : grid.near(place)) {
      if (facing.dot(triangles[t].area) >= 0) continue;  // they look the same way
      if (std::ranges::binary_search(neighbours_[p], t / 4)) continue;
      const auto& [a, b, c] = triangles[t].corners;
      const auto [of_corners, distance2] = closest_on_triangle(place, a, b, c);
      if (distance2 >= nearest2) continue;
      const std::array<NodeId, 4>& nodes = facets_[t / 4];
      std::array<double, 4> weights;
      weights.fill(of_corners[2] / 4);
      weights[t % 4] += of_corners[0];
      weights[(t + 1) % 4] += of_corners[1];
      Vec3 outside = Vec3::Zero();
      for (int k = 0; k < 4; ++k) outside += weights[k] * normals[nodes[k].index()].normalized();
      if (outside.norm() < 0.1 || outside.dot(facing) >= 0) continue;  // a sharp edge has no side
      // Along the shortest way: then nothing comes nearer by sliding.
      Pair found{p, nodes, weights, outside.normalized()};
      const Vec3 apart = found.apart(points_[p], x);
      if (std::ranges::all_of(of_corners, [](double weight) { return weight > 0; }))
        found.normal = triangles[t].area.normalized();
      else if (apart.norm() > 1e-3 * rule_.distance)
        found.normal = (apart.dot(outside) < 0 ? -apart : apart).normalized();
      if (found.gap(points_[p], x) < least_gap) continue;
      nearest2 = distance2;
      best = found;
    }
    if (!best) continue;
    // What lies beside an open surface, beyond its rim, is not over it.
    Vec3 out = Vec3::Zero();
    for (int k = 0; k < 4; ++k) out += best->weights[k] * outward[best->nodes[k].index()];
    if (out.dot(best->apart(points_[p], x)) > rule_.distance * out.norm()) continue;
    // One that comes into view nearer than the distance does not jump away.
    const double seen_at = was_seen ? last->distance : -std::numeric_limits<double>::infinity();
    best->first_gap = best->gap(points_[p], x);
    best->distance = std::min(rule_.distance, std::max(seen_at, best->first_gap));
    pairs.push_back(*best);
  }
  return pairs;
}

std::vector<Pair> SelfContact::pairs_of(std::span<const double> internal) {
  std::vector<Pair> pairs;
  for (std::size_t at = 1; at < internal.size(); at += pair_size)
    pairs.push_back(unpacked(internal.subspan(at, pair_size)));
  return pairs;
}

std::vector<NodeId> SelfContact::nodes_of(const Pair& pair) const {
  const Point& point = points_[pair.point];
  std::vector<NodeId> nodes(point.nodes.begin(), point.nodes.begin() + point.count);
  nodes.insert(nodes.end(), pair.nodes.begin(), pair.nodes.end());
  return nodes;
}

std::vector<double> SelfContact::packed(const std::vector<Pair>& pairs, std::span<const double> before) const {
  std::vector<double> numbers = {static_cast<double>(pattern_revision(before))};
  numbers.reserve(1 + pair_size * pairs.size());
  for (const Pair& pair : pairs) {
    numbers.push_back(static_cast<double>(pair.point));
    for (const NodeId node : pair.nodes) numbers.push_back(static_cast<double>(node.index()));
    numbers.insert(numbers.end(), pair.weights.begin(), pair.weights.end());
    numbers.insert(numbers.end(), pair.normal.begin(), pair.normal.end());
    numbers.push_back(pair.distance);
    numbers.push_back(pair.first_gap);
  }
  NodeGroups joined, joined_before;
  add_touching(numbers, joined);
  add_touching(before, joined_before);
  if (joined != joined_before) ++numbers.front();
  return numbers;
}

std::vector<double> SelfContact::first_internal(const Tissue& tissue) const {
  return packed(pairs(tissue.rest_positions), {});
}

std::vector<double> SelfContact::next_internal(const Step& step) const {
  return packed(pairs(step.positions, step.internal), step.internal);
}

// Calls take(point, pair, how far it is inside the distance) for every pair that is pressed.
template <class Take>
void SelfContact::for_pressed(const Step& step, const Take& take) const {
  for (std::size_t at = 1; at < step.internal.size(); at += pair_size) {
    const Pair pair = unpacked(step.internal.subspan(at, pair_size));
    const Point& point = points_[pair.point];
    const double inside = pair.distance - pair.gap(point, MirroredVectors{mirror_, step.positions});
    if (inside > 0) take(point, pair, inside);
  }
}

// Calls take(point, pair, friction, velocity) for every pair that was pressed when the step began; the velocity is that
// of the point along the facet.
template <class Take>
void SelfContact::for_rubbing(const Step& step, const Take& take) const {
  if (rule_.friction == 0) return;
  for (std::size_t at = 1; at < step.internal.size(); at += pair_size) {
    const Pair pair = unpacked(step.internal.subspan(at, pair_size));
    const Point& point = points_[pair.point];
    const double inside = pair.distance - pair.first_gap;
    if (inside <= 0) continue;
    const auto apart = [&](std::span<const Vec3> x) { return pair.apart(point, MirroredVectors{mirror_, x}); };
    take(point, pair, Coulomb{rule_.friction * rule_.stiffness * point.area * inside},
         pair.along(apart(step.positions) - step.before(apart)) / step.rate_s);
  }
}

double SelfContact::energy(const Step& step) const {
  double sum = 0;
  for_pressed(step, [&](const Point& point, const Pair&, double inside) {
    sum += 0.5 * rule_.stiffness * point.area * inside * inside;
  });
  for_rubbing(step, [&](const Point&, const Pair&, const Coulomb& friction, const Vec3& velocity) {
    sum += step.rate_s * friction.potential(velocity);
  });
  return sum;
}

void SelfContact::add_push(const Point& point, const Pair& pair, const Vec3& push, std::span<Vec3> forces) const {
  const auto add = [&](NodeId of_whole, double part) {
    const auto [node, signs] = mirror_.image(of_whole);
    forces[node.index()] += part * signs.cwiseProduct(push);
  };
  for (int i = 0; i < point.count; ++i) add(point.nodes[i], 1.0 / point.count);
  for (int k = 0; k < 4; ++k) add(pair.nodes[k], -pair.weights[k]);
}

EnergyFlow SelfContact::energy_flow(const MadeStep& made) const {
  // Pairs are found anew at the step's end, and what the old ones had stored beyond the new ones is lost.
  Step with_old_pairs = made.end;
  with_old_pairs.internal = made.begin.internal;
  const double now = energy(made.end);
  double rubbed = 0;
  for_rubbing(made.whole, [&](const Point&, const Pair&, const Coulomb& friction, const Vec3& velocity) {
    rubbed -= made.whole.rate_s * friction.force(velocity).dot(velocity);
  });
  return {.stored = now - energy(made.begin), .dissipated = energy(with_old_pairs) - now + rubbed};
}

void SelfContact::add_forces(const Step& step, std::span<Vec3> forces) const {
  for_pressed(step, [&](const Point& point, const Pair& pair, double inside) {
    add_push(point, pair, rule_.stiffness * point.area * inside * pair.normal, forces);
  });
  for_rubbing(step, [&](const Point& point, const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    add_push(point, pair, friction.force(velocity), forces);
  });
}

void SelfContact::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  for_pressed(step, [&](const Point& point, const Pair& pair, double) {
    const double closer = pair.gap(point, MirroredVectors{mirror_, direction});
    add_push(point, pair, rule_.stiffness * point.area * closer * pair.normal, product);
  });
  for_rubbing(step, [&](const Point& point, const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    const Vec3 slip = pair.along(pair.apart(point, MirroredVectors{mirror_, direction}));
    add_push(point, pair, pair.along(friction.resistance(velocity) * slip) / step.rate_s, product);
  });
}

void SelfContact::add_tangent(const Step& step, TangentSink& tangent) const {
  const auto add = [&](const Point& point, const Pair& pair, const Mat3& stiffness) {
    const std::vector<NodeId> nodes = nodes_of(pair);
    const auto weight = [&](int i) { return i < point.count ? 1.0 / point.count : -pair.weights[i - point.count]; };
    // One that has come from so far that its pattern leaves it out has what couples nodes of one side.
    const bool whole = may_touch(pair);
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i)
      for (int j = 0; j <= i; ++j)
        if (whole || (i < point.count) == (j < point.count)) {
          const auto [a, a_signs] = mirror_.image(nodes[i]);
          const auto [b, b_signs] = mirror_.image(nodes[j]);
          Mat3 block = weight(i) * weight(j) * (a_signs.asDiagonal() * stiffness * b_signs.asDiagonal());
          if (i != j && a == b) block += block.transpose().eval();  // a node and its image
          tangent.add_block(a, b, block);
        }
  };
  for_pressed(step, [&](const Point& point, const Pair& pair, double) {
    add(point, pair, rule_.stiffness * point.area * pair.normal * pair.normal.transpose());
  });
  for_rubbing(step, [&](const Point& point, const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    const Mat3 along = Mat3::Identity() - pair.normal * pair.normal.transpose();
    add(point, pair, along * friction.resistance(velocity) * along / step.rate_s);
  });
}

double SelfContact::rounding(const Step& step, double position_rounding) const {
  double sum = 0;
  for_rubbing(step, [&](const Point&, const Pair&, const Coulomb& friction, const Vec3&) {
    sum += (friction.resistance(Vec3::Zero()) / step.rate_s).squaredNorm();
  });
  return std::sqrt(sum) * position_rounding;
}

NodeGroups SelfContact::node_groups(std::span<const double> internal) const {
  NodeGroups groups;
  for (const Point& point : points_)
    if (point.count == 4) add_group(point.nodes, groups);
  add_touching(internal, groups);
  return groups;
}

void SelfContact::add_touching(std::span<const double> internal, NodeGroups& groups) const {
  for (const Pair& pair : pairs_of(internal))
    if (may_touch(pair)) add_group(nodes_of(pair), groups);
}

// As the side numbers them, each once.
void SelfContact::add_group(std::span<const NodeId> of_whole, NodeGroups& groups) const {
  std::vector<NodeId> nodes;
  for (const NodeId node : of_whole)
    if (const NodeId own = mirror_.image(node).node; std::ranges::find(nodes, own) == nodes.end()) nodes.push_back(own);
  groups.add(nodes);
}

std::unique_ptr<Law> SelfContact::after_division(const Tissue& tissue, const Division&, std::span<const Vec3>) const {
  return std::make_unique<SelfContact>(tissue, rule_);
}

}  // namespace plica
