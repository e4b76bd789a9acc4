// What becomes of a cortex when its tissue changes: faces before and after, reference areas, growth.
#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "mechanics/active/cortex.hpp"
#include "mechanics/growth.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

// Key of the cells of a face, independent of their order.
std::pair<int, int> cells_of(CellId cell, std::optional<CellId> beyond) {
  return std::minmax(cell.number(), beyond ? beyond->number() : -1);
}

}  // namespace

// Origin of a face: the earlier face with the same nodes, else all between the same cells; none between daughters, or
// cells that have met.
class Cortex::Origins {
 public:
  Origins(const Cortex& before, const TissueChange& change) : before_(before), change_(change) {
    for (std::size_t f = 0; f < before.faces_.size(); ++f) {
      const Face& face = before.faces_[f];
      by_nodes_[sorted(face.nodes)] = f;
      by_cells_[cells_of(face.cell, face.beyond)].push_back(f);
    }
  }

  [[nodiscard]] std::vector<std::vector<std::size_t>> of(std::span<const Face> faces) const {
    std::vector<std::vector<std::size_t>> origins;
    std::map<CellId, std::size_t> ordinals;
    for (const Face& face : faces) origins.push_back(of(face, ordinals[face.cell]++));
    if (shares() && change_.remeshed.empty()) leave_known(origins);
    return origins;
  }

  /// Whether cells are remeshed, or have been: reference positions mean nothing then, and faces may have no area there.
  [[nodiscard]] bool shares() const { return before_.is_remeshed_ || !change_.remeshed.empty(); }

  /// Reference areas that do not follow from areas in the undeformed tissue, given present ones and origins: of faces
  /// without origin, and of all that share that of their origins. 0: it follows from them.
  [[nodiscard]] std::vector<double> first_areas(std::span<const Face> faces, std::span<const double> now,
                                                const std::vector<std::vector<std::size_t>>& origins) const {
    std::map<std::vector<std::size_t>, double> wholes;
    for (std::size_t f = 0; f < faces.size(); ++f) wholes[origins[f]] += now[f];
    std::vector<double> first(faces.size(), 0.0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (origins[f].empty()) first[f] = change_.remeshed.empty() ? now[f] : mean_about(faces[f]).value_or(now[f]);
      if (!shares()) continue;
      for (const std::size_t from : origins[f]) first[f] += before_.rest_areas_[from] * (now[f] / wholes[origins[f]]);
    }
    return first;
  }

  /// Mean of values of these faces, weighted by their reference areas.
  [[nodiscard]] double mean(std::span<const std::size_t> faces, std::span<const double> values) const {
    double sum = 0, area = 0;
    for (const std::size_t f : faces) sum += before_.rest_areas_[f] * values[f], area += before_.rest_areas_[f];
    return sum / area;
  }

 private:
  // `ordinal`: among the faces of its cell.
  [[nodiscard]] std::vector<std::size_t> of(const Face& face, std::size_t ordinal) const {
    const auto origin = [&](CellId cell) { return change_.origin[cell.index()]; };
    const auto cells = cells_of(origin(face.cell), face.beyond ? std::optional(origin(*face.beyond)) : std::nullopt);
    const auto found = by_cells_.find(cells);
    if (!change_.remeshed.empty() && before_.rule_.side != CellSide::lateral)
      return change_.is_remeshed(face.cell) ? found->second : std::vector{found->second[ordinal]};
    // Hanging nodes are numbered again when cells change; a wall that turns keeps its nodes.
    std::array<NodeId, 4> nodes = sorted(face.nodes);
    const bool are_known =
        (change_.daughters.empty() && change_.remeshed.empty()) || nodes.back().index() < change_.kept_nodes();
    for (NodeId& node : nodes)
      if (node.index() < change_.kept_nodes()) node = change_.node_origin[node.index()];
    const auto is_between = [&](const Face& other) { return cells_of(other.cell, other.beyond) == cells; };
    if (const auto same = by_nodes_.find(nodes); are_known && same != by_nodes_.end())
      if (change_.remeshed.empty() || is_between(before_.faces_[same->second])) return {same->second};
    return found == by_cells_.end() ? std::vector<std::size_t>() : found->second;
  }

  // Faces known by their nodes keep what they have; others share the rest.
  static void leave_known(std::vector<std::vector<std::size_t>>& origins) {
    std::set<std::size_t> known;
    for (const std::vector<std::size_t>& from : origins)
      if (from.size() == 1) known.insert(from.front());
    for (std::vector<std::size_t>& from : origins) {
      std::vector<std::size_t> left;
      std::ranges::copy_if(from, std::back_inserter(left), [&](std::size_t f) { return !known.contains(f); });
      if (!left.empty()) from = std::move(left);
    }
  }

  // Mean reference area of the former faces of both cells.
  [[nodiscard]] std::optional<double> mean_about(const Face& face) const {
    double sum = 0;
    int count = 0;
    for (std::size_t f = 0; f < before_.faces_.size(); ++f)
      for (const CellId cell : {face.cell, face.beyond.value_or(face.cell)}) {
        if (before_.faces_[f].cell != cell && before_.faces_[f].beyond != cell) continue;
        sum += before_.rest_areas_[f];
        ++count;
      }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }

  static std::array<NodeId, 4> sorted(std::array<NodeId, 4> nodes) {
    std::ranges::sort(nodes);
    return nodes;
  }

  const Cortex& before_;
  const TissueChange& change_;
  std::map<std::array<NodeId, 4>, std::size_t> by_nodes_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> by_cells_;
};

void Cortex::inherit_faces(const Origins& origins, const Cortex& before, std::span<const Vec3> positions) {
  const std::vector<double> now = areas(positions);
  const auto all = origins.of(faces_);
  const std::vector<double> first = origins.first_areas(faces_, now, all);
  is_remeshed_ = origins.shares();
  if (is_remeshed_) rest_areas_.assign(faces_.size(), 1);
  std::vector<double> stretches;
  const std::vector<double> stretches_before = before.past();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const std::vector<std::size_t>& from = all[f];
    stretches.push_back(first[f] > 0 ? first[f] / rest_areas_[f] : origins.mean(from, stretches_before));
    // In a part of a tissue, the neighbour that is left out keeps its half of a wall, also when the part changes.
    if (from.empty() || faces_[f].beyond) continue;
    const Face& origin = before.faces_[from.front()];
    const double left = origin.beyond ? 0.5 : origin.share / faces_[f].share;
    faces_[f].share *= left;
    strengths_[f] *= left;
  }
  take_stretches(std::move(stretches));
}

void Cortex::take_stretches(std::vector<double> stretches) {
  stretches_ = std::move(stretches);
  for (std::size_t f = 0; f < faces_.size(); ++f) rest_areas_[f] *= stretches_[f];
  ungrown_areas_ = rest_areas_;
  take_rest_areas();
}

std::vector<double> Cortex::past() const {
  std::vector<double> stretches = stretches_;
  for (std::size_t f = 0; f < faces_.size(); ++f) stretches[f] *= rest_areas_[f] / ungrown_areas_[f];
  if (is_remeshed_) stretches.push_back(1);  // tells it
  return stretches;
}

std::unique_ptr<Law> Cortex::grown(const Tissue& tissue, std::span<const ElementId> /*elements*/,
                                   std::span<const GrowthTensor> tensors) const {
  auto law = std::make_unique<Cortex>(*this);
  if (tensors.empty()) return law;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    const Vec3& normal = rest_normals_[f];
    const double own = tensors[face.cell.index()].area(normal);
    law->rest_areas_[f] =
        ungrown_areas_[f] * (face.beyond ? 0.5 * (own + tensors[face.beyond->index()].area(normal)) : own);
  }
  law->take_rest_areas();
  law->activation_ = ShapeActivation(tissue, rule_.activation);
  law->kept_ = {};
  return law;
}

CortexRule Cortex::rule_after(const TissueChange& change) const {
  CortexRule rule = rule_;
  follow(change, rule);
  return rule;
}

std::unique_ptr<Law> Cortex::after_change(const Tissue& tissue, const TissueChange& change,
                                          std::span<const Vec3> positions) const {
  auto after = std::make_unique<Cortex>(tissue, pattern_.after_change(change), rule_after(change), kernels_);
  after->noise_ = noise_;
  after->inherit_faces(Origins(*this, change), *this, positions);
  return after;
}

std::unique_ptr<Law> Cortex::restored(const Tissue& tissue, const TissueChange& change, std::span<const Vec3>,
                                      std::span<const double> past) const {
  auto law = std::make_unique<Cortex>(tissue, pattern_.after_change(change), rule_after(change), kernels_);
  const std::size_t faces = law->faces_.size();
  law->is_remeshed_ = past.size() == faces + 1;
  if (past.size() != faces && !law->is_remeshed_) throw InvalidNumbers();
  if (law->is_remeshed_) law->rest_areas_.assign(faces, 1);
  const std::span<const double> stretches = past.first(faces);
  law->take_stretches({stretches.begin(), stretches.end()});
  return law;
}

std::vector<double> Cortex::internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                  const TissueChange& change, const ChangePositions& positions) const {
  const Memory before = memory(internal);
  std::vector<double> after, factors;
  if (flows() || !before.factors.empty()) {
    const std::vector<Face> faces = acting_faces(tissue, rule_.side, pattern_.after_change(change));
    const Origins origins(*this, change);
    const auto all = origins.of(faces);
    std::vector<double> now(faces.size(), 1);
    for (std::size_t f = 0; f < faces.size() && !positions.after.empty(); ++f)
      now[f] = facet_area(gather(positions.after, faces[f].nodes));
    const std::vector<double> first = origins.first_areas(faces, now, all);
    for (const std::span<const double> areas : {before.areas, before.areas_before})
      for (std::size_t f = 0; f < faces.size() && flows(); ++f)
        after.push_back(all[f].empty() ? now[f] / first[f] : origins.mean(all[f], areas));
    for (std::size_t f = 0; f < faces.size() && !before.factors.empty(); ++f)
      factors.push_back(all[f].empty() ? 1 : origins.mean(all[f], before.factors));
  }
  for (const std::span<const double> states : {before.activation, before.activation_before})
    if (!states.empty())
      std::ranges::copy(inherited(change, std::vector(states.begin(), states.end())), std::back_inserter(after));
  std::ranges::copy(factors, std::back_inserter(after));
  std::ranges::copy(before.given.after_change(change), std::back_inserter(after));
  return after;
}

}  // namespace plica
