// Derivatives of contact for gradients of runs: of forces by the pairs, and of pairs by the positions at which they
// were found. Features (triangle, edge, corner) of a pair are constants. Letters as in docs/theory/self_contact.md.
#include <algorithm>
#include <optional>

#include "mechanics/contact/self_contact.hpp"

namespace plica {
namespace {

/// Positions of the nodes of a pair.
struct PairNodes {
  std::array<Vec3, 4> p = still(), q = still();

  static std::array<Vec3, 4> still() { return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}; }
  PairNodes(const ContactPair& pair, const MirroredVectors& x) {
    for (int i = 0; i < pair.p.count(); ++i) p[i] = x[pair.p.nodes[i].index()];
    for (int i = 0; i < pair.q.count(); ++i) q[i] = x[pair.q.nodes[i].index()];
  }
  static Vec3 at(const SurfacePlace& place, const std::array<Vec3, 4>& nodes) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < place.count(); ++i) sum += place.weights[i] * nodes[i];
    return sum;
  }
};

Vec3 turned_like(const Vec3& normal, const Vec3& before) { return normal.dot(before) < 0 ? -normal : normal; }

/// Ends of the segment of a place, as in Segment::at.
std::pair<Vec3, Vec3> ends_of(const SurfacePlace& place, const std::array<Vec3, 4>& x) {
  if (place.count() == 2) return {x[0], x[1]};
  return {x[0], (x[0] + x[1] + x[2] + x[3]) / 4};
}
void put_on_segment(double part, SurfacePlace& place) {
  if (place.count() == 2)
    place.weights = {1 - part, part, 0, 0};
  else
    place.weights = {1 - 0.75 * part, 0.25 * part, 0.25 * part, 0.25 * part};
}

/// Return a pair of edges at other positions of its nodes.
ContactPair moved_edges(const ContactPair& pair, const PairNodes& x) {
  const auto [a, b] = ends_of(pair.p, x.p);
  const auto [c, d] = ends_of(pair.q, x.q);
  const Vec3 u = b - a, v = d - c, w = c - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  ContactPair moved = pair;
  put_on_segment((uw * vv - uv * vw) / determinant, moved.p);
  put_on_segment((uw * uv - uu * vw) / determinant, moved.q);
  moved.normal = turned_like(u.cross(v).normalized(), pair.normal);
  return moved;
}

/// Barycentric weights of a place on a triangle of its facet, from an edge of the facet to the centre.
struct OnTriangle {
  int edge;
  std::array<double, 3> weights;
};

/// Return the triangle of q: one of those on which it lies.
std::optional<OnTriangle> triangle_of(const SurfacePlace& q) {
  constexpr double rounding = 1e-12;
  for (int edge = 0; edge < 4; ++edge) {
    const double quarter = q.weights[(edge + 2) % 4];
    const double first = q.weights[edge] - quarter, second = q.weights[(edge + 1) % 4] - quarter;
    if (std::abs(q.weights[(edge + 3) % 4] - quarter) < rounding && std::min({first, second, quarter}) > -rounding)
      return OnTriangle{edge, {first, second, 4 * quarter}};
  }
  return std::nullopt;
}

/// Return a pair of a point and a facet at other positions of its nodes: the nearest place of the same feature.
ContactPair moved_point(const ContactPair& pair, const PairNodes& x) {
  const std::optional<OnTriangle> on = triangle_of(pair.q);
  if (!on) return pair;
  constexpr double some = 1e-14;
  const std::array<Vec3, 3> corners = {x.q[on->edge], x.q[(on->edge + 1) % 4], (x.q[0] + x.q[1] + x.q[2] + x.q[3]) / 4};
  const Vec3 p = PairNodes::at(pair.p, x.p);
  std::vector<int> used;
  for (int i = 0; i < 3; ++i)
    if (on->weights[i] > some) used.push_back(i);
  std::array<double, 3> weights = {};
  const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (used.size() == 3) {
    const Vec3 way = p - corners[0];
    weights[1] = way.cross(corners[2] - corners[0]).dot(area) / area.squaredNorm();
    weights[2] = (corners[1] - corners[0]).cross(way).dot(area) / area.squaredNorm();
    weights[0] = 1 - weights[1] - weights[2];
  } else if (used.size() == 2) {
    const Vec3 edge = corners[used[1]] - corners[used[0]];
    weights[used[1]] = (p - corners[used[0]]).dot(edge) / edge.squaredNorm();
    weights[used[0]] = 1 - weights[used[1]];
  } else {
    weights[used.front()] = 1;
  }
  ContactPair moved = pair;
  moved.q.weights.fill(weights[2] / 4);
  moved.q.weights[on->edge] += weights[0];
  moved.q.weights[(on->edge + 1) % 4] += weights[1];
  moved.normal =
      turned_like((used.size() == 3 ? area : Vec3(p - PairNodes::at(moved.q, x.q))).normalized(), pair.normal);
  return moved;
}

ContactPair moved_pair(const ContactPair& pair, const PairNodes& x) {
  ContactPair moved = pair.is_of_edges() ? moved_edges(pair, x) : moved_point(pair, x);
  moved.first_gap = moved.normal.dot(PairNodes::at(moved.p, x.p) - PairNodes::at(moved.q, x.q));
  return moved;
}

/// Numbers of a pair that positions determine, times their adjoints.
double along_adjoint(const ContactPair& pair, const ContactPair& adjoint) {
  double sum = pair.normal.dot(adjoint.normal) + pair.first_gap * adjoint.first_gap;
  for (int i = 0; i < 4; ++i)
    sum += pair.p.weights[i] * adjoint.p.weights[i] + pair.q.weights[i] * adjoint.q.weights[i];
  return sum;
}

/// Origin of the contact distance of a pair: the pair before with this index, its first gap, or else the rule.
struct DistanceOrigin {
  std::optional<std::size_t> before = {};
  bool is_first_gap = false;
};
DistanceOrigin origin_of_distance(const ContactPair& pair, std::span<const ContactPair> before, double of_rule) {
  if (pair.distance >= (pair.is_of_edges() ? of_rule / 2 : of_rule)) return {};
  const auto last = std::ranges::find_if(before, [&](const ContactPair& one) {
    return one.distance == pair.distance && one.is_of_edges() == pair.is_of_edges() &&
           (pair.is_of_edges() || one.first == pair.first);
  });
  if (last != before.end()) return {static_cast<std::size_t>(last - before.begin())};
  return {{}, pair.distance == pair.first_gap};
}

constexpr double size_um = 1e-5;  // of differences

/// Return the derivatives of the numbers of a pair that positions determine, along a motion of its nodes; the others 0.
ContactPair change_of(const ContactPair& pair, const PairNodes& x, const PairNodes& motion) {
  ContactPair change = {};
  double largest = 0;
  for (const auto* of_place : {&motion.p, &motion.q})
    for (const Vec3& of_node : *of_place) largest = std::max(largest, of_node.norm());
  if (largest == 0) return change;
  const double size = size_um / largest;
  const auto moved_by = [&](double signed_size) {
    PairNodes moved = x;
    for (int i = 0; i < 4; ++i) moved.p[i] += signed_size * motion.p[i], moved.q[i] += signed_size * motion.q[i];
    return moved_pair(pair, moved);
  };
  const ContactPair more = moved_by(size), less = moved_by(-size);
  const auto slope = [&]<class Value>(const Value& of_more, const Value& of_less) -> Value {
    return (of_more - of_less) / (2 * size);
  };
  for (int i = 0; i < 4; ++i) {
    change.p.weights[i] = slope(more.p.weights[i], less.p.weights[i]);
    change.q.weights[i] = slope(more.q.weights[i], less.q.weights[i]);
  }
  change.normal = slope(more.normal, less.normal);
  change.first_gap = slope(more.first_gap, less.first_gap);
  return change;
}

std::span<ContactPair> pairs_in(std::span<double> internal) {
  return {reinterpret_cast<ContactPair*>(internal.data() + 1), (internal.size() - 1) / numbers_of_pair};
}

}  // namespace

void SelfContact::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                     const BeginningGradient& gradient) const {
  const std::span<const Pair> pairs = pairs_of(step.internal);
  if (pairs.empty()) return;
  const std::span<Pair> of_pairs = pairs_in(gradient.internal);
  const auto of_pair = [&](const Pair& pair) -> Pair& {
    return of_pairs[static_cast<std::size_t>(&pair - pairs.data())];
  };
  const MirroredVectors x{mirror_, step.positions}, of_adjoint{mirror_, adjoint};
  // Add the gradient by weights of p and q, given that by the weight of a node of p.
  const auto add_by_weights = [&](const Pair& pair, const auto& by_weight) {
    for (int i = 0; i < pair.p.count(); ++i) of_pair(pair).p.weights[i] += by_weight(pair.p.nodes[i].index());
    for (int i = 0; i < pair.q.count(); ++i) of_pair(pair).q.weights[i] -= by_weight(pair.q.nodes[i].index());
  };

  // With m the distance of the adjoint's p and q, adjoint . forces of a pair is k w (D - N.(p - q)) N.m.
  for_pressed(step, [&](const Pair& pair, double inside) {
    const Vec3 m = pair.apart(of_adjoint), &N = pair.normal;
    const double stiffness = rule_.stiffness * pair.area, closer = N.dot(m);
    of_pair(pair).distance += stiffness * closer;
    of_pair(pair).normal += stiffness * (inside * m - closer * pair.apart(x));
    add_by_weights(pair,
                   [&](std::size_t n) { return stiffness * (inside * N.dot(of_adjoint[n]) - closer * N.dot(x[n])); });
  });

  // That of friction is m.f(v), f being proportional to D - first gap, and v = (I - N N^T) u / rate, with u the
  // movement of p - q since the beginning.
  for_rubbing(step, [&](const Pair& pair, const Coulomb& friction, const Vec3& velocity) {
    const auto moved = [&](auto of) { return Vec3(of(step.positions) - step.before(of)); };
    const auto node_moved = [&](std::size_t n) {
      return moved([&](std::span<const Vec3> at) { return MirroredVectors{mirror_, at}[n]; });
    };
    const Vec3 u = moved([&](std::span<const Vec3> at) { return pair.apart(MirroredVectors{mirror_, at}); });
    const Vec3 m = pair.apart(of_adjoint), &N = pair.normal, force = friction.force(velocity);
    const Vec3 by_v = -(friction.resistance(velocity) * m) / step.rate_s, by_u = pair.along(by_v);
    const double by_inside = m.dot(force) / (pair.distance - pair.first_gap);
    of_pair(pair).distance += by_inside;
    of_pair(pair).first_gap -= by_inside;
    of_pair(pair).normal -= N.dot(u) * by_v + by_v.dot(N) * u;
    add_by_weights(pair, [&](std::size_t n) { return force.dot(of_adjoint[n]) + by_u.dot(node_moved(n)); });
    add_push(pair, -(1 + step.ahead) * by_u, gradient.previous);
    if (step.ahead > 0) add_push(pair, step.ahead * by_u, gradient.earlier);
  });
}

void SelfContact::add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                                        std::span<Vec3> positions, const BeginningGradient& gradient) const {
  const std::span<const Pair> found = pairs_of(next), adjoints = pairs_of(adjoint), before = pairs_of(step.internal);
  const MirroredVectors x{mirror_, step.positions};
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Pair& pair = found[k];
    Pair of_pair = adjoints[k];
    if (of_pair.distance != 0) {
      const auto [place, is_first_gap] = origin_of_distance(pair, before, rule_.distance);
      if (place)
        pairs_in(gradient.internal)[*place].distance += of_pair.distance;
      else if (is_first_gap)
        of_pair.first_gap += of_pair.distance;
    }
    if (along_adjoint(of_pair, of_pair) == 0) continue;
    // By differences over the few coordinates that the pair depends on.
    PairNodes nodes(pair, x);
    const auto add = [&](const SurfacePlace& place, std::array<Vec3, 4>& of_nodes) {
      for (int i = 0; i < place.count(); ++i) {
        Vec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
          double& coordinate = of_nodes[i][axis];
          const double kept = coordinate;
          coordinate = kept + size_um;
          const double more = along_adjoint(moved_pair(pair, nodes), of_pair);
          coordinate = kept - size_um;
          const double less = along_adjoint(moved_pair(pair, nodes), of_pair);
          coordinate = kept;
          slope[axis] = (more - less) / (2 * size_um);
        }
        const auto [node, signs] = mirror_.image(place.nodes[i]);
        positions[node.index()] += signs.cwiseProduct(slope);
      }
    };
    add(pair.p, nodes.p);
    add(pair.q, nodes.q);
  }
}

void SelfContact::add_internal_change(const Step& step, std::span<const double> next, const StepChange& change,
                                      std::span<double> of_next) const {
  if (next.empty()) return;
  const std::span<const Pair> found = pairs_of(next), before = pairs_of(step.internal);
  const std::span<const Pair> of_before = pairs_of(change.internal);
  const std::span<Pair> of_found = pairs_in(of_next);
  const MirroredVectors x{mirror_, step.positions}, motion{mirror_, change.positions};
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Pair& pair = found[k];
    Pair of_pair = change_of(pair, {pair, x}, {pair, motion});
    const auto [place, is_first_gap] = origin_of_distance(pair, before, rule_.distance);
    const double of_distance = place ? of_before[*place].distance : is_first_gap ? of_pair.first_gap : 0;
    Pair& sum = of_found[k];
    for (int i = 0; i < 4; ++i) {
      sum.p.weights[i] += of_pair.p.weights[i];
      sum.q.weights[i] += of_pair.q.weights[i];
    }
    sum.normal += of_pair.normal;
    sum.first_gap += of_pair.first_gap;
    sum.distance += of_distance;
  }
}

}  // namespace plica
