#include "core/box_grid.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace plica {
Box box_of(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& point : points.subspan(1)) box.take(point);
  return box;
}

BoxGrid::BoxGrid(double cube_size, std::vector<Box> boxes) : cubes_per_um_(1 / cube_size), boxes_(std::move(boxes)) {
  std::vector<Cube> last_cubes;
  std::size_t count = 0;
  for (const Box& box : boxes_) {
    const Cube& from = first_cubes_.emplace_back(cube(box.low));
    const Cube& to = last_cubes.emplace_back(cube(box.high));
    std::size_t cubes = 1;
    for (int i = 0; i < 3; ++i) cubes *= static_cast<std::size_t>(to[i] - from[i] + 1);
    count += cubes;
  }
  // Sort by counting: boxes of each cube, places of the cubes, numbers.
  slots_.resize(std::bit_ceil(2 * count + 1));
  std::vector<std::uint32_t> slots, used;
  slots.reserve(count);
  for (std::size_t b = 0; b < boxes_.size(); ++b)
    for_cubes(first_cubes_[b], last_cubes[b], [&](const Cube& cube) {
      const std::uint64_t its_key = key(cube);
      const auto at = static_cast<std::uint32_t>(slot(its_key));
      if (slots_[at].end == 0) used.push_back(at);
      slots_[at].key = its_key;
      ++slots_[at].end;
      slots.push_back(at);
    });
  std::uint32_t begin = 0;
  for (const std::uint32_t at : used) {
    const std::uint32_t size = slots_[at].end;
    slots_[at].begin = slots_[at].end = begin;
    begin += size;
  }
  numbers_.resize(count);
  auto at = slots.begin();
  for (std::size_t b = 0; b < boxes_.size(); ++b)
    for_cubes(first_cubes_[b], last_cubes[b],
              [&](const Cube&) { numbers_[slots_[*at++].end++] = static_cast<std::uint32_t>(b); });
}

std::span<const std::uint32_t> BoxGrid::near(const Vec3& place) const {
  if (slots_.empty()) return {};
  const Slot& there = slots_[slot(key(cube(place)))];
  return std::span(numbers_).subspan(there.begin, there.end - there.begin);
}

BoxGrid::Cube BoxGrid::cube(const Vec3& place) const {
  Cube result{};
  for (int i = 0; i < 3; ++i) {
    const double at = place[i] * cubes_per_um_;
    const auto toward_zero = static_cast<std::int64_t>(at);
    result[i] = toward_zero - (at < static_cast<double>(toward_zero) ? 1 : 0);
  }
  return result;
}

// 21 bits a direction: two cubes of one key are a million cubes apart, and then too far to be a pair anyway.
std::uint64_t BoxGrid::key(const Cube& cube) {
  constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
  std::uint64_t result = 0;
  for (const std::int64_t i : cube) result = (result << 21) | (static_cast<std::uint64_t>(i) & mask);
  return result;
}

std::size_t BoxGrid::slot(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio spreads neighbours
  std::size_t at = (key * golden >> 32) & mask;
  while (slots_[at].end != 0 && slots_[at].key != key) at = (at + 1) & mask;
  return at;
}

}  // namespace plica
