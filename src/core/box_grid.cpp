#include "core/box_grid.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

Box box_of(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& point : points.subspan(1)) box.take(point);
  return box;
}

template <class Take>
void BoxGrid::for_cubes(const Box& box, const Take& take) const {
  const Cube from = cube(box.low), to = cube(box.high);
  for (long i = from[0]; i <= to[0]; ++i)
    for (long j = from[1]; j <= to[1]; ++j)
      for (long k = from[2]; k <= to[2]; ++k) take(key({i, j, k}));
}

void BoxGrid::add(std::size_t number, const Box& box) {
  for_cubes(box, [&](std::uint64_t key) { numbers_[key].push_back(number); });
}

std::span<const std::size_t> BoxGrid::near(const Vec3& place) const {
  const auto found = numbers_.find(key(cube(place)));
  return found == numbers_.end() ? std::span<const std::size_t>{} : std::span<const std::size_t>(found->second);
}

void BoxGrid::find_near(const Box& box, std::vector<std::size_t>& found) const {
  found.clear();
  for_cubes(box, [&](std::uint64_t key) {
    const auto there = numbers_.find(key);
    if (there != numbers_.end()) found.insert(found.end(), there->second.begin(), there->second.end());
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

BoxGrid::Cube BoxGrid::cube(const Vec3& place) const {
  return {std::lround(std::floor(place.x() / size_)), std::lround(std::floor(place.y() / size_)),
          std::lround(std::floor(place.z() / size_))};
}

// 21 bits a direction: two cubes of one key are a million cubes apart, and then too far to be a pair anyway.
std::uint64_t BoxGrid::key(const Cube& cube) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  std::uint64_t result = 0;
  for (const long i : cube) result = (result << 21) | (static_cast<std::uint64_t>(i) & mask);
  return result;
}

}  // namespace plica
