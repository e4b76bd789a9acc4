// Serialization of lists, for processes on the same machine.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace plica {

/// Error: the bytes end before the expected content.
class BytesEndEarly : public std::runtime_error {
 public:
  BytesEndEarly() : std::runtime_error("the bytes end early") {}
};

/// Append length and items of a vector or string; items are copied as in memory.
template <class Items>
void put(const Items& items, std::string& bytes) {
  const std::size_t count = items.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(items.data()), count * sizeof(typename Items::value_type));
}

/// Remove the content appended by `put` from the front and return it. Throws BytesEndEarly.
template <class Items>
Items take(std::string_view& bytes) {
  std::size_t count = 0;
  constexpr std::size_t item_size = sizeof(typename Items::value_type);
  if (bytes.size() < sizeof count) throw BytesEndEarly();
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes.remove_prefix(sizeof count);
  if (count > bytes.size() / item_size) throw BytesEndEarly();
  Items items;
  items.resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(items.data()), bytes.data(), count * item_size);
  bytes.remove_prefix(count * item_size);
  return items;
}

}  // namespace plica
