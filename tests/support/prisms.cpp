#include "support/prisms.hpp"

namespace plica::support {

PrismSheet honeycomb(int columns, int rows, double edge_um, double height_um) {
  PrismSheet sheet;
  std::map<std::pair<int, int>, std::size_t> known;  // in halves of a hexagon's width, and halves of an edge
  const double half_width = std::sqrt(3.0) / 2 * edge_um, half_edge = edge_um / 2;
  const Vec3 middle(half_width * (columns - 0.5), half_edge * 1.5 * (rows - 1), 0);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      auto& cell = sheet.cells.emplace_back();
      for (const auto& [x, y] : {std::pair(1, 1), {0, 2}, {-1, 1}, {-1, -1}, {0, -2}, {1, -1}}) {
        const std::pair place(2 * i + j % 2 + x, 3 * j + y);
        const auto [vertex, is_new] = known.emplace(place, sheet.apical.size());
        if (is_new) sheet.apical.push_back(Vec3(half_width * place.first, half_edge * place.second, 0) - middle);
        cell.push_back(vertex->second);
      }
    }
  for (const Vec3& x : sheet.apical) sheet.basal.push_back(x - height_um * Vec3::UnitZ());
  return sheet;
}

void exchange_neighbours(PrismSheet& sheet, std::size_t cell, std::size_t other) {
  auto &one = sheet.cells[cell], &two = sheet.cells[other];
  const auto place_of = [](const std::vector<std::size_t>& polygon, std::size_t vertex) {
    return std::ranges::find(polygon, vertex);
  };
  for (std::size_t i = 0; i < one.size(); ++i) {
    const std::size_t a = one[i], b = one[(i + 1) % one.size()];
    if (place_of(two, a) == two.end() || place_of(two, b) == two.end()) continue;
    // Beside the wall: `at_a` has a corner a only, before which b comes to stand (after it, in its order), and so on.
    std::size_t at_a = sheet.cells.size(), at_b = at_a;
    for (std::size_t c = 0; c < sheet.cells.size(); ++c) {
      if (c == cell || c == other) continue;
      if (place_of(sheet.cells[c], a) != sheet.cells[c].end()) at_a = c;
      if (place_of(sheet.cells[c], b) != sheet.cells[c].end()) at_b = c;
    }
    if (at_a == sheet.cells.size() || at_b == sheet.cells.size() || one.size() < 5 || two.size() < 5) return;
    // a stays with `one`, b with `two`.
    one.erase(place_of(one, b));
    two.erase(place_of(two, a));
    // Counter-clockwise, `one` then `at_b` go round a: at_a has ... (from two) b a (to one) ...
    auto& before = sheet.cells[at_a];
    auto& after = sheet.cells[at_b];
    // The edge of at_a that follows a leads along `two` or `one`: b belongs on two's side.
    const auto next = [&](const std::vector<std::size_t>& polygon, std::size_t vertex) {
      const auto at = place_of(polygon, vertex);
      return at + 1 == polygon.end() ? polygon.front() : *(at + 1);
    };
    const bool two_follows = place_of(two, next(before, a)) != two.end();
    before.insert(place_of(before, a) + (two_follows ? 1 : 0), b);
    const bool one_follows = place_of(one, next(after, b)) != one.end();
    after.insert(place_of(after, b) + (one_follows ? 1 : 0), a);
    // Turned by a right angle, and shortened.
    for (Vectors* vertices : {&sheet.apical, &sheet.basal}) {
      Vec3 &x = (*vertices)[a], &y = (*vertices)[b];
      const Vec3 middle = 0.5 * (x + y), half = 0.35 * (y - x);
      Vec3 of_one = Vec3::Zero();
      for (const std::size_t v : one) of_one += (*vertices)[v] / static_cast<double>(one.size());
      Vec3 turned(-half.y(), half.x(), half.z());
      if (turned.dot(of_one - middle) < 0) turned = -turned;
      x = middle + turned;
      y = middle - turned;
    }
    return;
  }
}

PrismSheet irregular_polygons(int columns, int rows, double edge_um, double height_um, double size, unsigned seed) {
  PrismSheet sheet = honeycomb(columns, rows, edge_um, height_um);
  std::set<std::size_t> taken;
  for (int j = 1; j + 2 < rows; ++j)
    for (int i = 1; i + 2 < columns; ++i) {
      const std::size_t cell = static_cast<std::size_t>(columns * j + i);
      if ((i + 3 * j) % 7 != 0 || taken.contains(cell) || taken.contains(cell + 1)) continue;
      exchange_neighbours(sheet, cell, cell + 1);
      taken.insert({cell, cell + 1});
    }
  Random random(seed);
  for (std::size_t v = 0; v < sheet.apical.size(); ++v) {
    Vec3 way = random.vector(size * edge_um);
    way.z() = 0;
    sheet.apical[v] += way;
    sheet.basal[v] += way;
  }
  return sheet;
}

}  // namespace plica::support
