#include "mechanics/contact/contact_pair.hpp"

namespace plica {
namespace {

constexpr double no_node = -1;

void pack(const SurfacePlace& place, std::vector<double>& numbers) {
  for (int i = 0; i < 4; ++i)
    numbers.push_back(i < place.count ? static_cast<double>(place.nodes[i].index()) : no_node);
  numbers.insert(numbers.end(), place.weights.begin(), place.weights.end());
}

SurfacePlace unpacked_place(std::span<const double> numbers) {
  SurfacePlace place;
  for (; place.count < 4 && numbers[place.count] != no_node; ++place.count) {
    place.nodes[place.count] = NodeId(static_cast<std::size_t>(numbers[place.count]));
    place.weights[place.count] = numbers[4 + place.count];
  }
  return place;
}

}  // namespace

void pack(const ContactPair& pair, std::vector<double>& numbers) {
  numbers.push_back(static_cast<double>(pair.first));
  numbers.push_back(pair.second);
  pack(pair.p, numbers);
  pack(pair.q, numbers);
  numbers.insert(numbers.end(), pair.normal.begin(), pair.normal.end());
  numbers.insert(numbers.end(), {pair.area, pair.distance, pair.first_gap});
}

ContactPair unpacked(std::span<const double> numbers) {
  return {static_cast<std::size_t>(numbers[0]),
          static_cast<int>(numbers[1]),
          unpacked_place(numbers.subspan(2, 8)),
          unpacked_place(numbers.subspan(10, 8)),
          Vec3(numbers[18], numbers[19], numbers[20]),
          numbers[21],
          numbers[22],
          numbers[23]};
}

}  // namespace plica
