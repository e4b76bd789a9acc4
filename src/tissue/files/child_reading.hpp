// File reading in a child process, for libraries that damaged files may crash; results are passed as bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/bytes.hpp"
#include "core/files.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {

/// Return the bytes that `read` returns in a child process, for read_in_child.
std::string bytes_from_child(const std::filesystem::path& file, const std::function<std::string()>& read,
                             const char* reader);

template <class Value>
concept IsList = requires(Value value) {
  value.clear();
};

/// Append a value: a list or text, also of lists; a map by name; a number that may lack.
template <class Value>
void put_value(const Value& value, std::string& bytes) {
  if constexpr (requires { value.has_value(); }) {
    put(std::vector(value.has_value() ? 1 : 0, value.value_or(0)), bytes);
  } else if constexpr (requires { typename Value::mapped_type; }) {
    put(std::vector{value.size()}, bytes);
    for (const auto& [name, item] : value) put(name, bytes), put_value(item, bytes);
  } else if constexpr (IsList<typename Value::value_type>) {
    put(std::vector{value.size()}, bytes);
    for (const auto& item : value) put_value(item, bytes);
  } else {
    put(value, bytes);
  }
}

/// Take a value from the front. Throws BytesEndEarly.
template <class Value>
void take_value(Value& value, std::string_view& bytes) {
  const auto for_items = [&](const auto& take_item) {
    const auto count = take<std::vector<std::size_t>>(bytes);
    if (count.size() != 1) throw BytesEndEarly();
    for (std::size_t i = 0; i < count[0]; ++i) take_item();
  };
  if constexpr (requires { value.has_value(); }) {
    if (const auto number = take<std::vector<typename Value::value_type>>(bytes); !number.empty()) value = number[0];
  } else if constexpr (requires { typename Value::mapped_type; }) {
    for_items([&] { take_value(value[take<std::string>(bytes)], bytes); });
  } else if constexpr (IsList<typename Value::value_type>) {
    for_items([&] { take_value(value.emplace_back(), bytes); });
  } else {
    value = take<Value>(bytes);
  }
}

/// Return the bytes of `Result::parts`, a tie of the members that are passed.
template <class Result>
std::string to_bytes(const Result& result) {
  std::string bytes;
  std::apply([&](const auto&... part) { (put_value(part, bytes), ...); }, Result::parts(result));
  return bytes;
}

/// Read a result back. MeshError if the bytes end early.
template <class Result>
Result from_bytes(std::string_view bytes) try {
  Result result;
  std::apply([&](auto&... part) { (take_value(part, bytes), ...); }, Result::parts(result));
  return result;
} catch (const BytesEndEarly&) {
  throw MeshError("the mesh ends early");
}

/// Return the result of `read`, run in a child process. Its FileError and MeshError are passed on; FileError if it
/// crashed, naming the library `reader`.
template <class Read>
auto read_in_child(const std::filesystem::path& file, const Read& read, const char* reader = "VTK") {
  return from_bytes<decltype(read())>(bytes_from_child(
      file, [&] { return to_bytes(read()); }, reader));
}

}  // namespace plica
