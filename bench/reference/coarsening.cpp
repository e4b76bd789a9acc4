#include "coarsening.hpp"

#include <algorithm>

namespace plica::reference {
namespace {

using Quad = std::array<int, 4>;

// A shell as layers of one surface.
struct Layers {
  std::vector<Quad> quads;                // of vertices
  std::vector<std::vector<int>> columns;  // nodes above each vertex, the innermost first
};

std::optional<Layers> layers_of(int nodes, std::span<const std::array<int, 8>> hexes) {
  std::vector<int> above(nodes, -1), vertex(nodes, -1);
  std::vector<char> is_above(nodes, 0);
  for (const auto& hex : hexes)
    for (int a = 0; a < 4; ++a) {
      if (above[hex[a]] != -1 && above[hex[a]] != hex[a + 4]) return std::nullopt;
      above[hex[a]] = hex[a + 4];
      is_above[hex[a + 4]] = 1;
    }
  Layers layers;
  for (int n = 0; n < nodes; ++n) {
    if (is_above[n]) continue;
    vertex[n] = static_cast<int>(layers.columns.size());
    auto& column = layers.columns.emplace_back();
    for (int node = n; node != -1; node = above[node]) column.push_back(node);
    if (column.size() < 2 || column.size() != layers.columns.front().size()) return std::nullopt;
  }
  for (const auto& hex : hexes)
    if (!is_above[hex[0]]) layers.quads.push_back({vertex[hex[0]], vertex[hex[1]], vertex[hex[2]], vertex[hex[3]]});
  if (layers.quads.size() * (layers.columns.front().size() - 1) != hexes.size()) return std::nullopt;
  return layers;
}

class Surface {
 public:
  Surface(std::size_t vertices, const std::vector<Quad>& quads) : quads_(quads), around_(vertices) {
    for (std::size_t q = 0; q < quads.size(); ++q)
      for (const int v : quads[q]) around_[v].push_back(static_cast<int>(q));
  }

  // In a closed surface as many edges meet at a vertex as quads.
  [[nodiscard]] bool regular(int v) const { return around_[v].size() == 4; }
  [[nodiscard]] const std::vector<int>& around(int v) const { return around_[v]; }

  [[nodiscard]] std::vector<int> neighbours(int v) const {
    std::vector<int> result;
    for (const int q : around_[v]) {
      const int k = corner(q, v);
      for (const int n : {quads_[q][(k + 1) % 4], quads_[q][(k + 3) % 4]})
        if (std::find(result.begin(), result.end(), n) == result.end()) result.push_back(n);
    }
    return result;
  }

  // Straight on through the regular vertex v, coming from u: the neighbour that shares no quad with u.
  [[nodiscard]] int opposite(int u, int v) const {
    for (const int n : neighbours(v)) {
      const bool shares =
          std::any_of(around_[v].begin(), around_[v].end(), [&](int q) { return has(q, u) && has(q, n); });
      if (n != u && !shares) return n;
    }
    return -1;
  }

  [[nodiscard]] int corner(int q, int v) const {
    return static_cast<int>(std::find(quads_[q].begin(), quads_[q].end(), v) - quads_[q].begin());
  }

 private:
  [[nodiscard]] bool has(int q, int v) const { return corner(q, v) < 4; }

  const std::vector<Quad>& quads_;
  std::vector<std::vector<int>> around_;
};

// Parents of each vertex: itself where it stays, the ends of a coarse edge, or (empty) the middle of a coarse quad.
std::optional<std::vector<std::vector<int>>> edge_parents(const Surface& surface, std::size_t vertices) {
  std::vector<std::vector<int>> parents(vertices);
  std::vector<int> waiting;
  for (std::size_t v = 0; v < vertices && waiting.empty(); ++v)
    if (!surface.regular(static_cast<int>(v))) waiting.push_back(static_cast<int>(v));
  if (waiting.empty()) return std::nullopt;
  parents[waiting.front()] = {waiting.front()};
  while (!waiting.empty()) {
    const int v = waiting.back();
    waiting.pop_back();
    for (const int middle : surface.neighbours(v)) {
      if (!surface.regular(middle) || parents[middle].size() == 1) return std::nullopt;
      const int end = surface.opposite(v, middle);
      if (end == -1 || parents[end].size() == 2) return std::nullopt;
      parents[middle] = {std::min(v, end), std::max(v, end)};
      if (parents[end].empty()) {
        parents[end] = {end};
        waiting.push_back(end);
      }
    }
  }
  return parents;
}

// The coarse quad about vertex `centre`, its first corner that of a fine quad where there is one, so that local axes
// stay; and parents of the centre.
std::optional<Quad> quad_about(const Surface& surface, const std::vector<Quad>& quads,
                               const std::vector<std::vector<int>>& parents, int centre) {
  if (!surface.regular(centre)) return std::nullopt;
  int first = -1;
  for (const int q : surface.around(centre))
    if (first == -1 || parents[quads[q][0]].size() == 1) first = q;
  const int away = (surface.corner(first, centre) + 2) % 4;
  const int start = quads[first][away], next = quads[first][(away + 1) % 4], last = quads[first][(away + 3) % 4];
  if (parents[start].size() != 1 || parents[next].size() != 2 || parents[last].size() != 2) return std::nullopt;
  const auto other_end = [&](int middle, int v) {
    return parents[middle][0] == v ? parents[middle][1] : parents[middle][0];
  };
  Quad quad{start, other_end(next, start), -1, other_end(last, start)};
  for (const int q : surface.around(centre)) {
    const int corner = quads[q][(surface.corner(q, centre) + 2) % 4];
    if (corner != quad[0] && corner != quad[1] && corner != quad[3]) quad[2] = corner;
  }
  if (quad[2] == -1) return std::nullopt;
  return quad;
}

}  // namespace

std::optional<CoarseMesh> coarsen(int nodes, std::span<const std::array<int, 8>> hexes) {
  const auto layers = layers_of(nodes, hexes);
  if (!layers) return std::nullopt;
  const std::size_t vertices = layers->columns.size();
  const Surface surface(vertices, layers->quads);
  auto parents = edge_parents(surface, vertices);
  if (!parents) return std::nullopt;
  std::vector<Quad> coarse_quads;
  std::vector<std::vector<int>> all_parents = *parents;
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!(*parents)[v].empty()) continue;
    const auto quad = quad_about(surface, layers->quads, *parents, static_cast<int>(v));
    if (!quad) return std::nullopt;
    coarse_quads.push_back(*quad);
    all_parents[v].assign(quad->begin(), quad->end());
  }
  if (4 * coarse_quads.size() != layers->quads.size()) return std::nullopt;

  CoarseMesh coarse;
  std::vector<int> number(vertices, -1);
  int kept = 0;
  for (std::size_t v = 0; v < vertices; ++v)
    if (all_parents[v].size() == 1) number[v] = kept++;
  const std::size_t height = layers->columns.front().size();
  std::vector<std::vector<int>> of_node(nodes);
  for (std::size_t layer = 0; layer < height; ++layer)
    for (std::size_t v = 0; v < vertices; ++v) {
      if (number[v] != -1) coarse.kept.push_back(layers->columns[v][layer]);
      for (const int parent : all_parents[v])
        of_node[layers->columns[v][layer]].push_back(static_cast<int>(layer) * kept + number[parent]);
    }
  coarse.starts.push_back(0);
  for (const auto& list : of_node) {
    coarse.parents.insert(coarse.parents.end(), list.begin(), list.end());
    coarse.starts.push_back(static_cast<int>(coarse.parents.size()));
  }
  for (int layer = 0; layer + 1 < static_cast<int>(height); ++layer)
    for (const auto& quad : coarse_quads) {
      auto& hex = coarse.hexes.emplace_back();
      for (int a = 0; a < 4; ++a) {
        hex[a] = layer * kept + number[quad[a]];
        hex[a + 4] = hex[a] + kept;
      }
    }
  return coarse;
}

}  // namespace plica::reference
