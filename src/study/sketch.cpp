#include "study/sketch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "study/frame_surface.hpp"
#include "study/plot.hpp"
#include "tissue/tissue.hpp"

namespace plica {
namespace {

constexpr double margin = 6;  // pixels around a picture

// Viridis at equal steps.
constexpr std::array<std::array<double, 3>, 9> viridis = {{{68, 1, 84},
                                                           {71, 44, 122},
                                                           {59, 81, 139},
                                                           {44, 113, 142},
                                                           {33, 144, 141},
                                                           {39, 173, 129},
                                                           {92, 200, 99},
                                                           {170, 220, 50},
                                                           {253, 231, 37}}};

std::string colour_of(double value, const ColourScale& scale, double light) {
  const double part = std::clamp((value - scale.low) / (scale.high - scale.low), 0.0, 1.0) * (viridis.size() - 1);
  const auto low = std::min<std::size_t>(static_cast<std::size_t>(part), viridis.size() - 2);
  std::array<int, 3> rgb{};
  for (int i = 0; i < 3; ++i) {
    const double channel =
        viridis[low][i] + (part - static_cast<double>(low)) * (viridis[low + 1][i] - viridis[low][i]);
    rgb[i] = static_cast<int>(std::lround(std::clamp(channel * light, 0.0, 255.0)));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

// A polygon on its way to paper: x to the right, y downwards, um.
struct Patch {
  double depth = 0;  // towards the eye; nearer ones are painted later
  std::vector<Pixel> points;
  std::string fill;
};

// Moves patches into the picture. All pictures of one size show the same place in the middle: `half_size` in um.
Svg painted(std::vector<Patch> patches, double half_width, double half_height, double um_per_pixel) {
  std::ranges::stable_sort(patches, {}, &Patch::depth);
  Svg svg(2 * (half_width / um_per_pixel + margin), 2 * (half_height / um_per_pixel + margin));
  for (Patch& patch : patches) {
    for (Pixel& point : patch.points)
      point = {svg.width() / 2 + point[0] / um_per_pixel, svg.height() / 2 + point[1] / um_per_pixel};
    svg.polygon(patch.points, patch.fill, "#222", 0.35);
  }
  return svg;
}

// Half the size of what is drawn, as if the body were at rest, so that a strip's pictures share one scale.
std::array<double, 2> half_size(const Vectors& points, const Vec3& right, const Vec3& up) {
  std::array<double, 2> half = {0, 0};
  for (const Vec3& point : points) {
    half[0] = std::max(half[0], std::abs(point.dot(right)));
    half[1] = std::max(half[1], std::abs(point.dot(up)));
  }
  return half;
}

// Where a plane cuts an element: the points on its edges, in order around their middle, and the mean value there.
std::vector<Vec3> cut_element(const HexPoints& points, int axis, double at) {
  std::vector<Vec3> cut;
  for (const auto& [a, b] : hex_edges) {
    const double before = points[a][axis] - at, after = points[b][axis] - at;
    if ((before < 0) == (after < 0)) continue;
    cut.push_back(points[a] + before / (before - after) * (points[b] - points[a]));
  }
  if (cut.empty()) return cut;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : cut) middle += point / static_cast<double>(cut.size());
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::ranges::sort(cut, {}, [&](const Vec3& p) { return std::atan2(p[v] - middle[v], p[u] - middle[u]); });
  return cut;
}

}  // namespace

Viewpoint ventral_view() { return {Vec3(0, 0, -1), Vec3(0, -1, 0)}; }
Viewpoint antero_ventral_view() { return {Vec3(-0.62, -0.38, -0.69), Vec3(0, -0.6, 0.8)}; }
Viewpoint side_view() { return {Vec3(0, -1, 0), Vec3(0, 0, 1)}; }

std::vector<double> displacements(const Frame& frame) {
  std::vector<double> values;
  for (const Vec3& displacement : frame.node_vectors.at("displacement_um")) values.push_back(displacement.norm());
  return values;
}

Svg sketch_surface(const Frame& frame, const std::vector<double>& node_values, const ColourScale& scale,
                   const Viewpoint& view, double um_per_pixel) {
  const Vec3 eye = view.from.normalized();
  const Vec3 right = view.up.cross(eye).normalized(), up = eye.cross(right);
  const Vec3 light = (eye + 0.5 * up - 0.3 * right).normalized();
  std::vector<Patch> patches;
  for (const auto& nodes : apical_facets(frame)) {
    Patch patch;
    std::array<Vec3, 4> corners;
    double value = 0;
    for (int i = 0; i < 4; ++i) {
      corners[i] = frame.positions[nodes[i].index()];
      value += node_values[nodes[i].index()] / 4;
      patch.depth += corners[i].dot(eye) / 4;
      patch.points.push_back({corners[i].dot(right), -corners[i].dot(up)});
    }
    const Vec3 normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
    if (normal.dot(eye) <= 0) continue;
    patch.fill = colour_of(value, scale, 0.55 + 0.45 * std::max(0.0, normal.dot(light)));
    patches.push_back(std::move(patch));
  }
  const auto half = half_size(frame.positions, right, up);
  return painted(std::move(patches), half[0], half[1], um_per_pixel);
}

Svg sketch_section(const Frame& frame, const std::vector<double>& node_values, const ColourScale& scale, int axis,
                   double at, double um_per_pixel) {
  const Vec3 right = axis == 0 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), up(0, 0, 1);
  std::vector<Patch> patches;
  for (const auto& nodes : frame.elements) {
    const std::vector<Vec3> cut = cut_element(gather(frame.positions, nodes), axis, at);
    if (cut.size() < 3) continue;
    Patch patch;
    double value = 0;
    for (const NodeId node : nodes) value += node_values[node.index()] / 8;
    for (const Vec3& point : cut) patch.points.push_back({point.dot(right), -point.dot(up)});
    patch.fill = colour_of(value, scale, 1);
    patches.push_back(std::move(patch));
  }
  const auto half = half_size(frame.positions, right, up);
  return painted(std::move(patches), half[0], half[1], um_per_pixel);
}

Svg strip(const std::vector<std::pair<std::string, Svg>>& pictures, std::size_t columns, const ColourScale& scale) {
  constexpr double heading = 20, bar_height = 46, bar_width = 220;
  double width = 0, height = 0;
  for (const auto& [name, picture] : pictures)
    width = std::max(width, picture.width()), height = std::max(height, picture.height());
  const std::size_t rows = (pictures.size() + columns - 1) / columns;
  Svg whole(std::max(width * static_cast<double>(columns), bar_width + 60),
            static_cast<double>(rows) * (height + heading) + bar_height);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double x = static_cast<double>(i % columns) * width,
                 y = static_cast<double>(i / columns) * (height + heading);
    const Svg& picture = pictures[i].second;
    whole.place(picture, {x + (width - picture.width()) / 2, y + heading + (height - picture.height()) / 2});
    whole.text({x + width / 2, y + 15}, pictures[i].first, {.size = 13, .anchor = "middle"});
  }
  // The colour bar.
  const double x = (whole.width() - bar_width) / 2, y = whole.height() - bar_height + 6;
  constexpr int steps = 44;
  for (int i = 0; i < steps; ++i)
    whole.rectangle({x + i * bar_width / steps, y}, bar_width / steps + 0.5, 10,
                    colour_of(scale.low + (i + 0.5) / steps * (scale.high - scale.low), scale, 1));
  for (const double tick : axis_ticks(scale.low, scale.high, false))
    whole.text({x + bar_width * (tick - scale.low) / (scale.high - scale.low), y + 22}, fmt::format("{:.4g}", tick),
               {.size = 11, .anchor = "middle"});
  whole.text({whole.width() / 2, y + 36}, scale.label, {.size = 12, .anchor = "middle"});
  return whole;
}

}  // namespace plica
