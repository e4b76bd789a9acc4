#include "level.hpp"

#include <algorithm>
#include <map>

namespace plica::reference {
namespace {

std::vector<double> at_kept(std::span<const double> fine, const std::vector<int>& kept) {
  std::vector<double> values;
  for (const int n : kept)
    for (int c = 0; c < 3; ++c) values.push_back(fine[3 * static_cast<std::size_t>(n) + c]);
  return values;
}

}  // namespace

Level::Level(const Scene& scene)
    : hexes_(scene.mesh().hexes),
      factor_(scene.settings().stiffness_factor()),
      mass_(scene.mesh().nodes.size() / 3, static_cast<float>(scene.settings().mass)),
      elements_(scene.mesh().nodes, hexes_, scene.settings().material) {
  for (const auto& spring : scene.mesh().springs) spring_weights_.push_back({{spring.i, 1}, {spring.j, -1}});
  join_springs();
}

Level::Level(const Level& finer, CoarseMesh mesh, const Settings& settings)
    : hexes_(mesh.hexes),
      mesh_(std::move(mesh)),
      factor_(settings.stiffness_factor()),
      mass_(mesh_.kept.size()),
      elements_(at_kept(finer.elements_.rest(), mesh_.kept), hexes_, settings.material) {
  const auto& [hexes, kept, starts, parents] = mesh_;
  for (std::size_t n = 0; n < finer.nodes(); ++n)
    for (int at = starts[n]; at < starts[n + 1]; ++at)
      mass_[parents[at]] += finer.mass_[n] / static_cast<float>(starts[n + 1] - starts[n]);
  for (const auto& weights : finer.spring_weights_) {
    std::map<int, double> coarse;
    for (const auto& [node, weight] : weights)
      for (int at = starts[node]; at < starts[node + 1]; ++at)
        coarse[parents[at]] += weight / (starts[node + 1] - starts[node]);
    std::erase_if(coarse, [](const auto& entry) { return entry.second == 0; });
    spring_weights_.emplace_back(coarse.begin(), coarse.end());
  }
  join_springs();
}

void Level::join_springs() {
  std::map<std::pair<int, int>, std::size_t> numbers;
  for (std::size_t s = 0; s < spring_weights_.size(); ++s)
    for (const auto& [i, of_i] : spring_weights_[s])
      for (const auto& [j, of_j] : spring_weights_[s]) {
        if (j > i) continue;
        const auto [place, is_new] = numbers.try_emplace({i, j}, pairs_.size());
        if (is_new) pairs_.push_back({i, j, {}});
        shares_.push_back({s, place->second, static_cast<float>(of_i * of_j)});
      }
}

void Level::turn_to(std::span<const double> x, const Scene& scene) {
  elements_.turn_to(x);
  for (auto& pair : pairs_) std::fill_n(pair.block, 9, 0.0F);
  for (const auto& [spring, pair, weight] : shares_)
    for (int k = 0; k < 9; ++k) pairs_[pair].block[k] += weight * static_cast<float>(scene.springs()[spring].block[k]);
}

void Level::multiply(std::span<const float> p, std::span<float> y) const {
  for (std::size_t n = 0; n < mass_.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) y[3 * n + c] = mass_[n] * p[3 * n + c];
  elements_.add_product(static_cast<float>(factor_), p, y);
  for (const auto& [i, j, block] : pairs_) {
    const float *from = &p[3 * static_cast<std::size_t>(j)], *back = &p[3 * static_cast<std::size_t>(i)];
    float *to = &y[3 * static_cast<std::size_t>(i)], *other = &y[3 * static_cast<std::size_t>(j)];
    for (int c = 0; c < 3; ++c) {
      const float* row = block + 3 * c;  // blocks are symmetric
      to[c] += row[0] * from[0] + row[1] * from[1] + row[2] * from[2];
      if (i != j) other[c] += row[0] * back[0] + row[1] * back[1] + row[2] * back[2];
    }
  }
}

BlockPattern Level::pattern() const {
  std::vector<int> groups;
  for (const auto& hex : hexes_) groups.insert(groups.end(), hex.begin(), hex.end());
  return pattern_of_groups(static_cast<int>(nodes()), groups, 8);  // a spring's nodes are those of one hexahedron
}

void Level::assemble(const BlockPattern& pattern, std::vector<float>& values) const {
  values.assign(9 * pattern.columns.size(), 0);
  const auto add = [&](int row, int column, const float* block) {
    const bool turned = row < column;
    float* value = &values[9 * static_cast<std::size_t>(pattern.find(std::max(row, column), std::min(row, column)))];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) value[3 * i + j] += block[turned ? 3 * j + i : 3 * i + j];
  };
  for (std::size_t n = 0; n < nodes(); ++n) {
    const float m = mass_[n], block[9] = {m, 0, 0, 0, m, 0, 0, 0, m};
    add(static_cast<int>(n), static_cast<int>(n), block);
  }
  elements_.write_blocks(factor_, blocks_);
  const float* block = blocks_.data();
  for (const auto& hex : hexes_)
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b, block += 9) add(hex[a], hex[b], block);
  for (const auto& pair : pairs_) add(pair.i, pair.j, pair.block);
}

std::vector<double> Level::diagonal() const {
  std::vector<double> blocks(9 * nodes());
  for (std::size_t n = 0; n < nodes(); ++n)
    for (std::size_t c = 0; c < 3; ++c) blocks[9 * n + 4 * c] = mass_[n];
  elements_.add_diagonal(factor_, blocks);
  for (const auto& [i, j, block] : pairs_)
    if (i == j)
      for (std::size_t k = 0; k < 9; ++k) blocks[9 * static_cast<std::size_t>(i) + k] += block[k];
  return blocks;
}

std::vector<double> Level::kept(std::span<const double> finer) const { return at_kept(finer, mesh_.kept); }

void Level::restrict_to(std::span<const float> finer, std::span<float> coarse) const {
  std::fill(coarse.begin(), coarse.end(), 0.0F);
  for (std::size_t n = 0; n + 1 < mesh_.starts.size(); ++n) {
    const int begin = mesh_.starts[n], end = mesh_.starts[n + 1];
    const float weight = 1.0F / static_cast<float>(end - begin);
    for (int at = begin; at < end; ++at)
      for (std::size_t c = 0; c < 3; ++c)
        coarse[3 * static_cast<std::size_t>(mesh_.parents[at]) + c] += weight * finer[3 * n + c];
  }
}

void Level::add_interpolated(std::span<const float> coarse, std::span<float> finer) const {
  for (std::size_t n = 0; n + 1 < mesh_.starts.size(); ++n) {
    const int begin = mesh_.starts[n], end = mesh_.starts[n + 1];
    const float weight = 1.0F / static_cast<float>(end - begin);
    for (int at = begin; at < end; ++at)
      for (std::size_t c = 0; c < 3; ++c)
        finer[3 * n + c] += weight * coarse[3 * static_cast<std::size_t>(mesh_.parents[at]) + c];
  }
}

}  // namespace plica::reference
