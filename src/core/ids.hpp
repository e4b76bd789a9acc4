// Type-safe indices: a NodeId is neither a CellId nor an int.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace plica {

/// Index of an item in its flat array. `index()` is for subscripts.
template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value_(static_cast<std::int32_t>(index)) {}
  constexpr explicit Id(int index) : value_(index) {}
  [[nodiscard]] constexpr std::size_t index() const { return static_cast<std::size_t>(value_); }
  [[nodiscard]] constexpr int number() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return value_ >= 0; }
  [[nodiscard]] constexpr bool is_among(std::size_t count) const { return valid() && index() < count; }
  constexpr auto operator<=>(const Id&) const = default;

 private:
  std::int32_t value_ = -1;
};

using NodeId = Id<struct NodeTag>;
using ElementId = Id<struct ElementTag>;
using CellId = Id<struct CellTag>;

}  // namespace plica
