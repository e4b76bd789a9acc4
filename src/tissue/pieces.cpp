#include "tissue/pieces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

namespace plica {

std::size_t Pieces::largest() const {
  return static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
}

std::string Pieces::text(const char* things) const {
  constexpr std::size_t most_named = 5;
  std::vector<std::size_t> named = sizes;
  std::ranges::sort(named, std::greater());
  const std::size_t unnamed = named.size() - std::min(named.size(), most_named + 1);
  const std::size_t last = unnamed > 0 ? 0 : named.back();
  named.resize(unnamed > 0 ? most_named : named.size() - 1);
  return fmt::format("{} pieces of {} and {} {}", sizes.size(), fmt::join(named, ", "),
                     unnamed > 0 ? "fewer" : std::to_string(last), things);
}

}  // namespace plica
