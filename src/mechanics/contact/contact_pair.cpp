#include "mechanics/contact/contact_pair.hpp"

namespace plica {

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
  // Rounding may not tell on which side of an end a place lies; an end is a point's business.
  constexpr double least_sine = 1e-3, least_part = 1e-9;
  const Vec3 u = b - a, v = d - c, w = c - a;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > least_sine * least_sine * uu * vv)) return std::nullopt;
  // Where the way between the lines a + s u and c + t v is across both.
  const double s = (uw * vv - uv * vw) / determinant, t = (uw * uv - uu * vw) / determinant;
  const auto is_inside = [](double part) { return part > least_part && part < 1 - least_part; };
  if (!is_inside(s) || !is_inside(t)) return std::nullopt;
  return PlacesOnSegments{s, t};
}

}  // namespace plica
