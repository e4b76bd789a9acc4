#include "record/csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace plica {
namespace {

constexpr int digits = 10;
constexpr double largest_short = 1e9;  // integers below it are written in full

char* put_number(char* at, char* end, double value) {
  const auto whole = std::abs(value) < largest_short ? static_cast<long>(value) : 0L;
  if (static_cast<double>(whole) == value) return std::to_chars(at, end, whole).ptr;  // includes -0
  return std::to_chars(at, end, value, std::chars_format::general, digits).ptr;
}

}  // namespace

std::string csv_rows(std::span<const double> values, std::size_t columns) {
  std::string text;
  text.reserve(values.size() * (digits + 2));
  std::array<char, 32> number;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i % columns == 0 ? '\n' : ',';
    if (std::isfinite(values[i]))
      text.append(number.data(), put_number(number.data(), number.data() + number.size(), values[i]));
  }
  return text;
}

std::string csv_row(std::span<const std::optional<double>> values) {
  std::vector<double> numbers;
  numbers.reserve(values.size());
  for (const std::optional<double>& value : values)
    numbers.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  return csv_rows(numbers, numbers.size());
}

}  // namespace plica
