// Search for boxes near a place: a grid of cubes, each listing the boxes that overlap it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct Box {
  Vec3 low, high;
  void take(const Vec3& place) { low = low.cwiseMin(place), high = high.cwiseMax(place); }
  [[nodiscard]] Box widened(double by) const { return {low.array() - by, high.array() + by}; }
  [[nodiscard]] bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Return the smallest box that holds these points, at least one.
Box box_of(std::span<const Vec3> points);

class BoxGrid {
 public:
  explicit BoxGrid(double cube_size) : size_(cube_size) {}

  void add(std::size_t number, const Box& box);
  /// Return the boxes of the cube at the place, in order of insertion.
  [[nodiscard]] std::span<const std::size_t> near(const Vec3& place) const;
  /// Find the boxes of all cubes that a box overlaps, each once, ascending; replaces the content of `found`.
  void find_near(const Box& box, std::vector<std::size_t>& found) const;

 private:
  using Cube = std::array<long, 3>;
  [[nodiscard]] Cube cube(const Vec3& place) const;
  [[nodiscard]] static std::uint64_t key(const Cube& cube);
  template <class Take>
  void for_cubes(const Box& box, const Take& take) const;

  double size_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> numbers_;
};

}  // namespace plica
