#include "mechanics/contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"
#include "mechanics/contact/nonconforming_edges.hpp"

namespace plica {
namespace {

using Pair = ContactPair;

Vec3 area_vector(const std::array<NodeId, 4>& facet, std::span<const Vec3> x) {
  return facet_area_vector({x[facet[0].index()], x[facet[1].index()], x[facet[2].index()], x[facet[3].index()]});
}

using Triangle = std::array<Vec3, 3>;

// Four a facet, from its edges to the mean of its corners.
std::vector<Triangle> triangles_of(const std::vector<std::array<NodeId, 4>>& facets, std::span<const Vec3> x) {
  std::vector<Triangle> triangles;
  triangles.reserve(4 * facets.size());
  for (const auto& facet : facets) {
    Vec3 middle = Vec3::Zero();
    for (const NodeId node : facet) middle += x[node.index()] / 4;
    for (std::size_t edge = 0; edge < 4; ++edge)
      triangles.push_back({x[facet[edge].index()], x[facet[(edge + 1) % 4].index()], middle});
  }
  return triangles;
}

// An internal state is the revision of the pattern, then the numbers of pairs.
std::vector<double> numbers_of(int revision, const std::vector<Pair>& pairs) {
  std::vector<double> numbers = {static_cast<double>(revision)};
  const auto* of_pairs = reinterpret_cast<const double*>(pairs.data());
  numbers.insert(numbers.end(), of_pairs, of_pairs + numbers_of_pair * pairs.size());
  return numbers;
}

bool have_common_node(std::span<const KeptNode> some, std::span<const NodeId> others) {
  return std::ranges::any_of(some, [&](NodeId node) { return std::ranges::find(others, node) != others.end(); });
}

}  // namespace

SelfContact::SelfContact(const Tissue& whole, const SelfContactRule& rule, Mirror mirror)
    : rule_(rule), mirror_(std::move(mirror)) {
  std::map<NodeId, std::vector<std::size_t>> of_node;
  std::map<NodeId, double> area_of_node;
  std::vector<double> areas;  // 0 of images, whose points are not this side's
  for (const Facet& facet : whole.facets(rule.side)) {
    const bool is_own = mirror_.original(facet.cell) == facet.cell;
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
  const NonconformingEdges nonconforming(whole, edges);
  for (const auto& [edge, facet] : edges)
    if (!edges.contains({edge.second, edge.first}) && !nonconforming.is_inner(edge))
      rim_.push_back({edge.first, edge.second, facet});
  // Add a point: a node, or the mean of the nodes of an edge or a facet.
  const auto add_point = [&](const std::array<NodeId, 4>& nodes, int count, double area) {
    if (area == 0) return;
    SurfacePlace place(nodes, count);
    for (int i = 0; i < count; ++i) place.weights[i] = 1.0 / count;
    points_.push_back({place, area});
    std::set<std::size_t> around = count == 1 ? nonconforming.across(nodes[0]) : std::set<std::size_t>();
    std::set<NodeId> at = count == 2 ? nonconforming.lying_on({nodes[0], nodes[1]}) : std::set<NodeId>();
    at.insert(nodes.begin(), nodes.begin() + count);
    for (const NodeId node : at) around.insert(of_node[node].begin(), of_node[node].end());
    neighbours_.emplace_back(around.begin(), around.end());
  };
  for (const auto& [node, facets] : of_node) add_point({node}, 1, area_of_node[node]);
  for (std::size_t f = 0; f < facets_.size(); ++f) add_point(facets_[f], 4, areas[f] / 4);
  for (const auto& [edge, facet] : edges) {
    const auto other = edges.find({edge.second, edge.first});
    const bool on_rim = other == edges.end();
    if (!on_rim && edge.second < edge.first) continue;
    add_point({edge.first, edge.second}, 2, (areas[facet] + (on_rim ? 0 : areas[other->second])) / 8);
  }
  if (rule.with_edges) edges_ = EdgePairs(facets_, areas, nonconforming.lying());
}

// Position at the beginning of a step.
struct SelfContact::Surface {
  std::span<const Vec3> x;  // nodes of the whole
  Vectors normals;          // of nodes, by the area vectors of their facets
  Vectors outward;          // of nodes on the rim of an open surface: the way out of it; else zero
  std::vector<Triangle> triangles;
  Vectors areas;        // twice the area vectors of triangles: most are only asked where they look
  const BoxGrid& grid;  // of the facets

  Surface(const SelfContact& law, std::span<const Vec3> positions)
      : x(positions),
        normals(x.size(), Vec3::Zero()),
        outward(x.size(), Vec3::Zero()),
        triangles(triangles_of(law.facets_, x)),
        grid(law.grid_of(x)) {
    areas.reserve(triangles.size());
    for (const auto& [a, b, middle] : triangles) areas.push_back((b - a).cross(middle - a));
    for (const auto& facet : law.facets_) {
      const Vec3 area = area_vector(facet, x);
      for (const NodeId node : facet) normals[node.index()] += area;
    }
    for (const auto& [from, to, facet] : law.rim_) {
      const Vec3 out = (x[to.index()] - x[from.index()]).cross(area_vector(law.facets_[facet], x)).normalized();
      outward[from.index()] += out;
      outward[to.index()] += out;
    }
  }
};

const BoxGrid& SelfContact::grid_of(std::span<const Vec3> x) const {
  const auto stays = [&](const Vec3& now, const Vec3& then) { return (now - then).norm() <= margin(); };
  if (std::ranges::equal(x, grid_.positions, stays)) return grid_.facets;
  std::vector<Box> boxes;
  double longest = 0;
  for (const auto& [a, b, c, d] : facets_) {
    const std::array corners = {x[a.index()], x[b.index()], x[c.index()], x[d.index()]};
    boxes.push_back(box_of(corners).widened(rule_.search + margin()));
    longest = std::max({longest, (corners[2] - corners[0]).norm(), (corners[3] - corners[1]).norm()});
  }
  grid_ = {{x.begin(), x.end()}, BoxGrid(std::max(rule_.search, 0.5 * longest), std::move(boxes))};
  return grid_.facets;
}

// Whether no facet about q is nearer to the place than q itself.
bool SelfContact::is_nearest_about(const SurfacePlace& q, const Vec3& place, const Surface& surface) const {
  const double limit = (1 - 1e-9) * (q.at(surface.x) - place).squaredNorm();
  const auto is_about = [&](const std::array<NodeId, 4>& facet) {
    for (int k = 0; k < q.count(); ++k)
      if (q.weights[k] > 0 && std::ranges::find(facet, NodeId(q.nodes[k])) != facet.end()) return true;
    return false;
  };
  for (const std::size_t f : surface.grid.near(place)) {
    if (!is_about(facets_[f])) continue;
    for (const auto& [a, b, c] : std::span(surface.triangles).subspan(4 * f, 4))
      if (closest_on_triangle(place, a, b, c).squared_distance < limit) return false;
  }
  return true;
}

std::vector<SelfContact::Touch> SelfContact::touches_of(std::span<const Pair> pairs, std::span<const Vec3> x) {
  std::vector<Touch> touches;
  for (const Pair& pair : pairs) touches.push_back({pair.q.at(x), pair.gap(x), pair.distance});
  return touches;
}

std::optional<Pair> SelfContact::pair_of(std::size_t p, std::span<const Touch> known, const Surface& surface,
                                         const Pair* first) const {
  const auto& [x, normals, outward, triangles, areas, grid] = surface;
  const SurfacePlace& point = points_[p].place;
  const Vec3 place = point.at(x), facing = point.at(normals).normalized();
  const double within = first ? reach_of_second() : rule_.search;
  double nearest2 = within * within;
  std::optional<Pair> best;
  const auto is_facing = [&](const Vec3& area) { return facing.dot(area) < 0; };
  for (const std::size_t f : grid.near(place)) {
    if (std::ranges::none_of(std::span(areas).subspan(4 * f, 4), is_facing)) continue;  // nearly all of them
    if (std::ranges::binary_search(neighbours_[p], f)) continue;
    if (first && have_common_node(first->q.all_nodes(), facets_[f])) continue;
    for (std::size_t t = 4 * f; t < 4 * f + 4; ++t) {
      if (!is_facing(areas[t])) continue;
      const auto& [a, b, c] = triangles[t];
      const auto [of_corners, distance2] = closest_on_triangle(place, a, b, c);
      if (distance2 >= nearest2) continue;
      SurfacePlace q(facets_[f], 4);
      q.weights.fill(of_corners[2] / 4);
      q.weights[t % 4] += of_corners[0];
      q.weights[(t + 1) % 4] += of_corners[1];
      Vec3 outside = Vec3::Zero();
      for (int k = 0; k < 4; ++k) outside += q.weights[k] * normals[q.nodes[k].index()].normalized();
      if (outside.norm() < 0.1) continue;  // a sharp edge has no side
      // Normal along the shortest connection, so that sliding reduces no gap.
      Pair found{static_cast<double>(p), Pair::no_segment, point, q, outside.normalized(), points_[p].area};
      const Vec3 apart = found.apart(x);
      if (std::ranges::all_of(of_corners, [](double weight) { return weight > 0; }))
        found.normal = areas[t].normalized();
      else if (apart.norm() > 1e-3 * rule_.distance)
        found.normal = (apart.dot(outside) < 0 ? -apart : apart).normalized();
      // Tips of two ridges that face the same way may touch; then each is the nearest place of the other.
      constexpr double rounded = -1e-9;  // of a cosine: what is square to each other on one side is so on its image
      if (found.normal.dot(facing) > rounded) continue;
      if ((first || outside.dot(facing) >= 0) && !is_nearest_about(q, place, surface)) continue;
      // Admissible penetration: after contact, one distance more than its last pair, which lags.
      const Vec3 at_q = q.at(x);
      const auto last =
          std::ranges::min_element(known, {}, [&](const Touch& touch) { return (touch.place - at_q).squaredNorm(); });
      const bool is_known = last != known.end();
      const double last_gap = is_known ? last->gap : std::numeric_limits<double>::infinity();
      found.first_gap = found.gap(x);
      if (found.first_gap < (last_gap < rule_.distance ? std::min(0.0, last_gap) - rule_.distance : 0)) continue;
      // A pair detected below the contact distance starts without force, so nothing jumps apart.
      const double seen_at = is_known ? last->distance : -std::numeric_limits<double>::infinity();
      found.distance = std::min(rule_.distance, std::max(seen_at, found.first_gap));
      nearest2 = distance2;
      best = found;
    }
  }
  return best;
}

// Pairs of a point, at most two.
std::vector<Pair> SelfContact::pairs_at(std::size_t p, std::span<const Touch> known, const Surface& surface) const {
  std::vector<Pair> pairs;
  const auto add = [&](const Pair& pair) {
    // Points beyond the boundary of an open surface are not above it.
    const Vec3 out = pair.q.at(surface.outward);
    if (out.dot(pair.apart(surface.x)) <= rule_.distance * out.norm()) pairs.push_back(pair);
  };
  const std::optional<Pair> first = pair_of(p, known, surface, nullptr);
  if (!first) return pairs;
  add(*first);
  // Where three ridges meet, a point touches two.
  if (first->apart(surface.x).norm() < reach_of_second())
    if (const std::optional<Pair> second = pair_of(p, known, surface, &*first)) add(*second);
  return pairs;
}

std::vector<Pair> SelfContact::pairs(std::span<const Vec3> positions, std::span<const double> known) const {
  const std::span<const Pair> before = pairs_of(known);  // of points, by point; then of edges
  const auto of_points = before.first(std::ranges::find_if(before, &Pair::is_of_edges) - before.begin());
  return pairs(positions, before, [&](std::size_t p, std::span<const Vec3> x) {
    const auto of_p = std::ranges::equal_range(of_points, static_cast<double>(p), {}, &Pair::first);
    return touches_of({of_p.begin(), of_p.end()}, x);
  });
}

template <class KnownOf>
std::vector<Pair> SelfContact::pairs(std::span<const Vec3> positions, std::span<const Pair> before,
                                     const KnownOf& known_of) const {
  const Vectors of_whole = mirror_.is_used() ? mirror_.full_vectors(positions) : Vectors();
  const Surface surface(*this, mirror_.is_used() ? std::span<const Vec3>(of_whole) : positions);
  std::vector<std::vector<Pair>> at(points_.size());
  const auto find_at = [&](std::size_t p) { at[p] = pairs_at(p, known_of(p, surface.x), surface); };
  parallel_for(at.size(), find_at, long_bodies);
  std::vector<Pair> pairs;
  for (const std::vector<Pair>& found : at) pairs.insert(pairs.end(), found.begin(), found.end());
  // Edges are searched only near the points of pairs.
  std::vector<char> is_searched(surface.x.size(), 0);
  for (const Pair& pair : pairs)
    for (const SurfacePlace* place : {&pair.p, &pair.q})
      for (const NodeId node : place->all_nodes()) is_searched[mirror_.image(node).node.index()] = 1;
  const std::vector<Pair> of_edges =
      edges_.find({surface.x, surface.areas}, rule_.distance, mirror_, before, is_searched);
  pairs.insert(pairs.end(), of_edges.begin(), of_edges.end());
  return pairs;
}

std::span<const Pair> SelfContact::pairs_of(std::span<const double> internal) {
  if (internal.empty()) return {};
  return {reinterpret_cast<const Pair*>(internal.data() + 1), (internal.size() - 1) / numbers_of_pair};
}

std::vector<double> SelfContact::packed(const std::vector<Pair>& pairs, std::span<const double> before) const {
  std::vector<double> numbers = numbers_of(groups_revision(before), pairs);
  NodeGroups joined, joined_before;
  add_touching(numbers, joined);
  add_touching(before, joined_before);
  if (joined != joined_before) ++numbers.front();
  return numbers;
}

std::optional<std::vector<double>> SelfContact::internal_of_whole(std::span<const double> of_side) const {
  // A point on a plane is its own image, and a pair of edges across it may be the image of another: areas add up.
  using Nodes = std::array<NodeId, 4>;
  const auto nodes_of = [](const SurfacePlace& place) {
    Nodes nodes;
    std::ranges::copy(place.nodes, nodes.begin());
    std::ranges::sort(nodes);
    return nodes;
  };
  std::map<std::tuple<bool, Nodes, Nodes>, std::size_t> known;
  std::vector<Pair> pairs;
  const Pair* before = nullptr;
  for (const Pair& pair : pairs_of(of_side)) {
    const bool is_second = !pair.is_of_edges() && before != nullptr && before->first == pair.first;
    before = &pair;
    for (const auto& [signs, nodes] : mirror_.reflections) {
      Pair image = pair;
      image.normal = signs.cwiseProduct(pair.normal);
      for (SurfacePlace* place : {&image.p, &image.q})
        for (int i = 0, count = place->count(); i < count; ++i) place->nodes[i] = nodes[place->nodes[i].index()];
      Nodes of_p = nodes_of(image.p), of_q = pair.is_of_edges() ? nodes_of(image.q) : Nodes();
      if (pair.is_of_edges() && of_q < of_p) std::swap(of_p, of_q);
      const auto [place, is_new] = known.try_emplace({is_second, of_p, of_q}, pairs.size());
      if (is_new)
        pairs.push_back(image);
      else
        pairs[place->second].area += pair.area;
    }
  }
  return numbers_of(0, pairs);
}

double SelfContact::energy(const Step& step) const {
  double sum = 0;
  for_pressed(step,
              [&](const Pair& pair, double inside) { sum += 0.5 * rule_.stiffness * pair.area * inside * inside; });
  for_rubbing(step, [&](const Pair&, const Coulomb& friction, const Vec3& velocity) {
    sum += step.rate_s * friction.potential(velocity);
  });
  return sum;
}

void SelfContact::add_push(const Pair& pair, const Vec3& push, std::span<Vec3> forces) const {
  const auto add = [&](const SurfacePlace& place, double sign) {
    for (int i = 0; i < place.count(); ++i) {
      const auto [node, signs] = mirror_.image(place.nodes[i]);
      forces[node.index()] += sign * place.weights[i] * signs.cwiseProduct(push);
    }
  };
  add(pair.p, 1);
  add(pair.q, -1);
}

EnergyFlow SelfContact::energy_flow(const CompletedStep& completed) const {
  // Pairs are detected again at the end of the step; energy stored by old pairs beyond the new ones is dissipated.
  Step with_old_pairs = completed.end;
  with_old_pairs.internal = completed.begin.internal;
  const double now = energy(completed.end);
  double rubbed = 0;
  for_rubbing(completed.motion, [&](const Pair&, const Coulomb& friction, const Vec3& velocity) {
    rubbed -= completed.motion.rate_s * friction.force(velocity).dot(velocity);
  });
  return {.stored = now - energy(completed.begin), .dissipated = energy(with_old_pairs) - now + rubbed};
}

void SelfContact::add_forces(const Step& step, std::span<Vec3> forces) const {
  for_pressed(step, [&](const Pair& pair, double inside) {
    add_push(pair, rule_.stiffness * pair.area * inside * pair.normal, forces);
  });
  for_rubbing(step, [&](const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    add_push(pair, friction.force(velocity), forces);
  });
}

void SelfContact::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  for_pressed(step, [&](const Pair& pair, double) {
    const double closer = pair.gap(MirroredVectors{mirror_, direction});
    add_push(pair, rule_.stiffness * pair.area * closer * pair.normal, product);
  });
  for_rubbing(step, [&](const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    const Vec3 slip = pair.along(pair.apart(MirroredVectors{mirror_, direction}));
    add_push(pair, pair.along(friction.resistance(velocity) * slip) / step.rate_s, product);
  });
}

void SelfContact::add_tangent(const Step& step, TangentSink& tangent) const {
  const auto add = [&](const Pair& pair, const Mat3& stiffness) {
    const int of_p = pair.p.count(), of_both = of_p + pair.q.count();
    const auto is_of_p = [&](int i) { return i < of_p; };
    const auto node = [&](int i) { return is_of_p(i) ? pair.p.nodes[i] : pair.q.nodes[i - of_p]; };
    const auto weight = [&](int i) { return is_of_p(i) ? pair.p.weights[i] : -pair.q.weights[i - of_p]; };
    // A pair that moved here from outside its pattern contributes only the blocks that couple nodes of one side.
    const bool whole = may_touch(pair);
    for (int i = 0; i < of_both; ++i)
      for (int j = 0; j <= i; ++j)
        if (whole || is_of_p(i) == is_of_p(j)) {
          const auto [a, a_signs] = mirror_.image(node(i));
          const auto [b, b_signs] = mirror_.image(node(j));
          Mat3 block = weight(i) * weight(j) * (a_signs.asDiagonal() * stiffness * b_signs.asDiagonal());
          if (i != j && a == b) block += block.transpose().eval();  // a node and its image
          tangent.add_block(a, b, block);
        }
  };
  for_pressed(step, [&](const Pair& pair, double) {
    add(pair, rule_.stiffness * pair.area * pair.normal * pair.normal.transpose());
  });
  for_rubbing(step, [&](const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    const Mat3 along = Mat3::Identity() - pair.normal * pair.normal.transpose();
    add(pair, along * friction.resistance(velocity) * along / step.rate_s);
  });
}

double SelfContact::rounding(const Step& step, double position_rounding) const {
  double sum = 0;
  for_rubbing(step, [&](const Pair&, const Coulomb& friction, const Vec3&) {
    sum += (friction.resistance(Vec3::Zero()) / step.rate_s).squaredNorm();
  });
  return std::sqrt(sum) * position_rounding;
}

NodeGroups SelfContact::node_groups(std::span<const double> internal) const {
  NodeGroups groups;
  for (const Point& point : points_)
    if (point.place.count() == 4) add_group(point.place.nodes, groups);
  add_touching(internal, groups);
  return groups;
}

void SelfContact::add_touching(std::span<const double> internal, NodeGroups& groups) const {
  for (const Pair& pair : pairs_of(internal)) {
    if (!may_touch(pair)) continue;
    std::vector<KeptNode> nodes(pair.p.all_nodes().begin(), pair.p.all_nodes().end());
    nodes.insert(nodes.end(), pair.q.all_nodes().begin(), pair.q.all_nodes().end());
    add_group(nodes, groups);
  }
}

// Add the nodes as numbered on the solved side, each once.
void SelfContact::add_group(std::span<const KeptNode> of_whole, NodeGroups& groups) const {
  std::vector<NodeId> nodes;
  for (const NodeId node : of_whole)
    if (const NodeId own = mirror_.image(node).node; std::ranges::find(nodes, own) == nodes.end()) nodes.push_back(own);
  groups.add(nodes);
}

std::unique_ptr<Law> SelfContact::after_change(const Tissue& tissue, const TissueChange&, std::span<const Vec3>) const {
  return std::make_unique<SelfContact>(tissue, rule_);
}

std::vector<double> SelfContact::internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                       const TissueChange&, const ChangePositions& positions) const {
  if (positions.after.empty()) return {};  // of a part: contact belongs to none
  const SelfContact after(tissue, rule_);
  const std::span<const Pair> before = pairs_of(internal);
  const auto pairs = after.pairs(positions.after, {}, [&](std::size_t p, std::span<const Vec3> x) {
    const Vec3 place = after.points_[p].place.at(x);
    // Of the nearest point that had pairs, if it is as near as points of the surface are to each other.
    double nearest = std::numeric_limits<double>::infinity();
    std::vector<Pair> known;
    for (const Pair& pair : before) {
      if (pair.is_of_edges()) break;
      const double away = (pair.p.at(positions.before) - place).squaredNorm();
      if (away > std::min(nearest, 4 * pair.area)) continue;
      if (away < nearest) known.clear();
      nearest = away;
      known.push_back(pair);
    }
    return touches_of(known, positions.before);
  });
  return after.packed(pairs, {});
}

}  // namespace plica
