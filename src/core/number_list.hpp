// Values as a list of numbers and back, by one description for both directions. A class lists its members:
//   static auto parts(auto& value) { return std::tie(value.first, value.second); }
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// Error: the numbers are not those of such values.
struct InvalidNumbers : std::domain_error {
  InvalidNumbers() : std::domain_error("its numbers are invalid") {}
};

/// List of numbers: constant values are appended to it, others are taken from its front. Lists and maps begin with
/// their length, values that may be missing with whether they exist.
class NumberList {
 public:
  explicit NumberList(std::vector<double>& list) : list_(list) {}

  template <class... Values>
  void pass(Values&... values) {
    (pass_one(values), ...);
  }
  [[nodiscard]] bool all_taken() const { return at_ == list_.size(); }

 private:
  template <class Number>
  Number next() {
    if (all_taken()) throw InvalidNumbers();
    const double value = list_[at_++];
    if constexpr (std::integral<Number>) {
      constexpr double exact = 9007199254740992.0;  // largest range of exact integers in doubles
      using Limits = std::numeric_limits<Number>;
      if (value < std::max(-exact, static_cast<double>(Limits::lowest())) ||
          value > std::min(exact, static_cast<double>(Limits::max())) || value != std::floor(value))
        throw InvalidNumbers();
    }
    return static_cast<Number>(value);
  }

  /// Append a constant number; take another.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void pass_one(Number& number) {
    if constexpr (std::is_const_v<Number>)
      list_.push_back(static_cast<double>(number));
    else
      number = next<Number>();
  }

  template <class Tag>
  void pass_one(const Id<Tag>& id) {
    list_.push_back(id.number());
  }
  template <class Tag>
  void pass_one(Id<Tag>& id) {
    id = Id<Tag>(next<int>());
  }

  void pass_one(const std::optional<double>& value) {
    list_.insert(list_.end(), {value ? 1.0 : 0.0, value.value_or(0)});
  }
  void pass_one(std::optional<double>& value) {
    const bool exists = next<bool>();
    const double number = next<double>();
    value = exists ? std::optional(number) : std::nullopt;
  }

  template <class Type>
  void pass_one(const std::shared_ptr<const Type>& shared) {
    list_.push_back(shared ? 1 : 0);
    if (shared) pass(*shared);
  }
  template <class Type>
  void pass_one(std::shared_ptr<const Type>& shared) {
    shared = nullptr;
    if (!next<bool>()) return;
    Type value;
    pass(value);
    shared = std::make_shared<const Type>(std::move(value));
  }

  template <class Item, std::size_t count>
  void pass_one(const std::array<Item, count>& items) {
    for (const Item& item : items) pass(item);
  }
  template <class Item, std::size_t count>
  void pass_one(std::array<Item, count>& items) {
    for (Item& item : items) pass(item);
  }
  void pass_one(const Vec3& vector) { list_.insert(list_.end(), vector.begin(), vector.end()); }
  void pass_one(Vec3& vector) {
    for (double& number : vector) number = next<double>();
  }

  template <class List>
  requires requires(std::remove_const_t<List> list) { list.resize(0), list.push_back(list.back()); }
  void pass_one(List& list) {
    if constexpr (std::is_const_v<List>) {
      list_.push_back(static_cast<double>(list.size()));
    } else {
      const auto size = next<std::size_t>();
      if (size > list_.size() - at_) throw InvalidNumbers();
      list.resize(size);
    }
    for (auto& item : list) pass_one(item);
  }
  template <class Map>
  requires requires { typename Map::mapped_type; }
  void pass_one(Map& map) {
    if constexpr (std::is_const_v<Map>) {
      list_.push_back(static_cast<double>(map.size()));
      for (const auto& [name, value] : map) pass(name, value);
    } else {
      for (auto left = next<std::size_t>(); left > 0; --left) {
        std::string name;
        pass_one(name);
        pass_one(map[name]);
      }
    }
  }
  template <class Value>
  requires requires(Value& value) { std::remove_const_t<Value>::parts(value); }
  void pass_one(Value& value) {
    std::apply([&](auto&... part) { pass(part...); }, std::remove_const_t<Value>::parts(value));
  }

  std::vector<double>& list_;
  std::size_t at_ = 0;
};

/// Return values as numbers.
template <class... Values>
std::vector<double> as_numbers(const Values&... values) {
  std::vector<double> list;
  NumberList(list).pass(values...);
  return list;
}

/// Set values from all of these numbers. Throws InvalidNumbers.
template <class... Values>
void take_numbers(std::vector<double> numbers, Values&... values) {
  NumberList list(numbers);
  list.pass(values...);
  if (!list.all_taken()) throw InvalidNumbers();
}

}  // namespace plica
