// Search for boxes near a place: a grid of cubes, each listing the boxes that overlap it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
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
  BoxGrid() = default;
  BoxGrid(double cube_size, std::vector<Box> boxes);

  /// Return the boxes of the cube at the place, ascending.
  [[nodiscard]] std::span<const std::uint32_t> near(const Vec3& place) const;
  /// Find the boxes from number `first` on that overlap a box, each once, ascending; replaces the content of `found`.
  void find_overlapping(const Box& box, std::vector<std::uint32_t>& found, std::size_t first = 0) const {
    find_overlapping(box, found, first, [](std::uint32_t) { return true; });
  }
  /// Find those whose numbers are wanted.
  template <class Wanted>
  void find_overlapping(const Box& box, std::vector<std::uint32_t>& found, std::size_t first,
                        const Wanted& wanted) const;

 private:
  using Cube = std::array<std::int64_t, 3>;
  struct Slot {  // of a hash table: a cube that has boxes, and their part of numbers_
    std::uint64_t key = 0;
    std::uint32_t begin = 0, end = 0;
  };
  template <class Take>
  static void for_cubes(const Cube& from, const Cube& to, const Take& take) {
    for (std::int64_t i = from[0]; i <= to[0]; ++i)
      for (std::int64_t j = from[1]; j <= to[1]; ++j)
        for (std::int64_t k = from[2]; k <= to[2]; ++k) take(Cube{i, j, k});
  }
  [[nodiscard]] Cube cube(const Vec3& place) const;
  [[nodiscard]] static std::uint64_t key(const Cube& cube);
  /// Return the slot of a key, or the empty one where it would be.
  [[nodiscard]] std::size_t slot(std::uint64_t key) const;

  double cubes_per_um_ = 1;
  std::vector<Box> boxes_;
  std::vector<Cube> first_cubes_;  // of the boxes
  std::vector<Slot> slots_;        // as many as a power of two
  std::vector<std::uint32_t> numbers_;
};

template <class Wanted>
void BoxGrid::find_overlapping(const Box& box, std::vector<std::uint32_t>& found, std::size_t first,
                               const Wanted& wanted) const {
  found.clear();
  if (slots_.empty()) return;
  const Cube from = cube(box.low);
  for_cubes(from, cube(box.high), [&](const Cube& cube) {
    const Slot& there = slots_[slot(key(cube))];
    for (std::uint32_t n = there.end; n > there.begin && numbers_[n - 1] >= first; --n) {
      const std::uint32_t b = numbers_[n - 1];
      if (!wanted(b)) continue;
      // Two boxes are found in the first cube that they have in common.
      const Cube& its = first_cubes_[b];
      if (std::max(its[0], from[0]) != cube[0] || std::max(its[1], from[1]) != cube[1] ||
          std::max(its[2], from[2]) != cube[2])
        continue;
      if (boxes_[b].overlaps(box)) found.push_back(b);
    }
  });
  std::ranges::sort(found);
}

}  // namespace plica
