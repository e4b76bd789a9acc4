// Numbers as few bytes in a page of text: whole numbers coded so that they compress well.
// viewer/src/packed.ts reads them.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Arrays of whole numbers under one roof. Each number is kept as its difference from the one `period` before it
/// (modulo 2^bits), and of each array all lowest bytes come first, then the next ones: what changes little from frame
/// to frame becomes long runs of the same byte.
class PackedArrays {
 public:
  void add(std::string name, std::span<const std::uint16_t> values, std::size_t period);
  void add(std::string name, std::span<const std::uint32_t> values, std::size_t period);

  /// Bytes of all arrays, not yet deflated.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

  /// A JSON list of {name, bits, period, count, offset}: where each array begins in the bytes.
  [[nodiscard]] nlohmann::ordered_json index() const;

 private:
  struct Entry {
    std::string name;
    int bits;
    std::size_t period, count, offset;
  };
  template <class Number>
  void add_numbers(std::string name, std::span<const Number> values, std::size_t period);

  std::vector<Entry> entries_;
  std::string bytes_;
};

/// A range of numbers in 65536 equal steps.
struct Quantiser {
  double low = 0, high = 0;
  void include(double value);
  /// The step nearest to the value.
  [[nodiscard]] std::uint16_t step_of(double value) const;

 private:
  bool any_ = false;
};

}  // namespace plica
