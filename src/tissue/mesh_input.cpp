#include "tissue/mesh_input.hpp"

#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/tissue.hpp"

namespace plica {
std::string place_text(const Vec3& place) {
  const auto rounded = [](double x) { return std::abs(x) < 1e-9 ? 0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) um", rounded(place.x()), rounded(place.y()), rounded(place.z()));
}

std::string cell_at(const Tissue& tissue, CellId cell) {
  return fmt::format("cell {} at {}", cell.index(),
                     place_text(cell_centre(tissue.cells[cell.index()], tissue.rest_positions)));
}

std::string cell_at(const HexahedralMesh& mesh, std::size_t cell) { return cell_text(cell, mesh, mesh.cells[cell]); }

std::string cell_text(std::size_t cell, const HexahedralMesh& mesh, const std::array<NodeId, 8>& nodes) {
  Vec3 middle = Vec3::Zero();
  for (const NodeId node : nodes) middle += mesh.points[node.index()] / 8;
  return fmt::format("cell {} at {}", cell, place_text(middle));
}

void Placement::turn(Vectors& points) const {
  Mat3 turned = scale.asDiagonal();
  for (int axis = 0; axis < 3; ++axis)
    if (rotate_deg[axis] != 0)
      turned =
          Eigen::AngleAxisd(rotate_deg[axis] * std::numbers::pi / 180, Vec3::Unit(axis)).toRotationMatrix() * turned;
  for (Vec3& point : points) point = rotate_deg.isZero(0) ? Vec3(point.cwiseProduct(scale)) : Vec3(turned * point);
}

void move_to_origin(Vectors& points, const Vec3& centre) {
  for (Vec3& point : points) point -= centre;
}

// Points are sorted along a direction that no grid is likely to be square to, so that few are compared.
std::vector<std::size_t> first_in_place(const Vectors& points, std::vector<std::size_t> numbers, double tolerance_um) {
  const Vec3 direction(0.5772157, 0.2146018, 0.7878593);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<std::pair<double, std::size_t>> sorted;
  for (const std::size_t number : numbers) sorted.emplace_back(direction.dot(points[number]), number);
  std::ranges::sort(sorted);
  std::vector<std::size_t> first(points.size());
  std::iota(first.begin(), first.end(), std::size_t{0});
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = i + 1; j < sorted.size() && sorted[j].first - sorted[i].first <= tolerance_um; ++j) {
      const auto [low, high] = std::minmax(sorted[i].second, sorted[j].second);
      if ((points[low] - points[high]).norm() <= tolerance_um) first[high] = std::min(first[high], first[low]);
    }
  for (std::size_t& one : first) one = first[one];
  return first;
}

std::size_t Pieces::largest() const {
  return static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
}

std::string Pieces::text(const char* things) const {
  constexpr std::size_t most_named = 5;
  std::vector<std::size_t> named = sizes;
  std::ranges::sort(named, std::greater());
  const std::size_t unnamed = named.size() - std::min(named.size(), most_named + 1);
  const std::size_t last = unnamed > 0 ? 0 : named.back();
  named.resize(unnamed > 0 ? most_named : named.size() - 1);
  return fmt::format("{} pieces of {} and {} {}", sizes.size(), fmt::join(named, ", "),
                     unnamed > 0 ? "fewer" : std::to_string(last), things);
}

}  // namespace plica
