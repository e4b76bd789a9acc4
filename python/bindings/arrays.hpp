// Conversion of numbers to NumPy arrays: read-only copies, so that none changes with the simulation.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica::python {

namespace nb = nanobind;

/// Wrap `numbers`, which are deleted with `owner`.
template <class Number>
nb::object numpy_array(const Number* numbers, std::size_t dimensions, const std::size_t* shape,
                       const nb::capsule& owner) {
  using Array = nb::ndarray<nb::numpy, const Number, nb::c_contig>;
  nb::object array = nb::cast(Array(numbers, dimensions, shape, owner), nb::rv_policy::move);
  array.attr("setflags")(nb::arg("write") = false);
  return array;
}

/// Make an array with rows of `width` numbers; one-dimensional if the width is 1.
template <class Number>
nb::object array_of(std::vector<Number> numbers, std::size_t width = 1) {
  auto* kept = new std::vector<Number>(std::move(numbers));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Number>*>(p); });
  const std::size_t shape[2] = {kept->size() / width, width};
  return numpy_array(kept->data(), width == 1 ? 1 : 2, shape, owner);
}

inline nb::object array_of(std::span<const Vec3> vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vec3& vector : vectors) numbers.insert(numbers.end(), vector.begin(), vector.end());
  return array_of(std::move(numbers), 3);
}

inline nb::object array_of(const std::vector<bool>& flags) {
  auto* kept = new bool[flags.size()];
  std::copy(flags.begin(), flags.end(), kept);
  const nb::capsule owner(kept, [](void* p) noexcept { delete[] static_cast<bool*>(p); });
  const std::size_t shape[1] = {flags.size()};
  return numpy_array(kept, 1, shape, owner);
}

/// Make an array of values of nodes or cells, `width` per row.
template <class Lists>
nb::object array_of_ids(const Lists& lists, std::size_t width) {
  std::vector<int> numbers;
  numbers.reserve(lists.size() * width);
  for (const auto& list : lists)
    for (const auto id : list) numbers.push_back(id.number());
  return array_of(std::move(numbers), width);
}

}  // namespace plica::python
