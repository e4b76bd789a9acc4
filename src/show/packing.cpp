#include "show/packing.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace plica {

template <class Number>
void PackedArrays::add_numbers(std::string name, std::span<const Number> values, std::size_t period) {
  const std::size_t count = values.size(), offset = bytes_.size();
  entries_.push_back({std::move(name), 8 * static_cast<int>(sizeof(Number)), period, count, offset});
  bytes_.resize(offset + count * sizeof(Number));
  for (std::size_t i = 0; i < count; ++i) {
    const auto change = static_cast<Number>(i < period ? values[i] : values[i] - values[i - period]);
    for (std::size_t b = 0; b < sizeof(Number); ++b)
      bytes_[offset + b * count + i] = static_cast<char>(change >> (8 * b) & 0xff);
  }
}

void PackedArrays::add(std::string name, std::span<const std::uint16_t> values, std::size_t period) {
  add_numbers(std::move(name), values, period);
}

void PackedArrays::add(std::string name, std::span<const std::uint32_t> values, std::size_t period) {
  add_numbers(std::move(name), values, period);
}

nlohmann::ordered_json PackedArrays::index() const {
  nlohmann::ordered_json index = nlohmann::ordered_json::array();
  for (const Entry& entry : entries_)
    index.push_back({{"name", entry.name},
                     {"bits", entry.bits},
                     {"period", entry.period},
                     {"count", entry.count},
                     {"offset", entry.offset}});
  return index;
}

void Quantiser::include(double value) {
  low = any_ ? std::min(low, value) : value;
  high = any_ ? std::max(high, value) : value;
  any_ = true;
}

std::uint16_t Quantiser::step_of(double value) const {
  if (!(high > low)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::clamp((value - low) / (high - low), 0.0, 1.0) * 65535));
}

}  // namespace plica
