// Compact encoding of integers for report pages, read by viewer/src/packed.ts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Collection of integer arrays that compresses well. Each number is stored as its difference from the one `period`
/// earlier (modulo 2^bits), with all lowest bytes of an array first, then the next ones: small changes between
/// snapshots become long runs of equal bytes.
class PackedArrays {
 public:
  void add(std::string name, std::span<const std::uint16_t> values, std::size_t period);
  void add(std::string name, std::span<const std::uint32_t> values, std::size_t period);

  /// Bytes of all arrays, before compression.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

  /// JSON list of {name, bits, period, count, offset} with the position of each array in the bytes.
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

/// Quantization of a range in 65536 equal steps.
struct Quantiser {
  double low = 0, high = 0;
  void include(double value);
  /// Step nearest to a value.
  [[nodiscard]] std::uint16_t step_of(double value) const;

 private:
  bool any_ = false;
};

}  // namespace plica
