// Unilateral constraints: a shell around the embryo, a plane, another surface.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "mechanics/law.hpp"
#include "tissue/outer_shape.hpp"

namespace plica {

struct Model;

/// Unilateral constraint: gaps g(x) >= 0 of some nodes, without friction or adhesion. A node in contact is pushed along
/// dg/dx.
class Obstacle {
 public:
  /// Gap of a node (positive inside, um), its gradient (length 1) and Hessian (1/um).
  using Gap = OuterShape::Gap;

  virtual ~Obstacle() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Obstacle> clone() const = 0;

  /// Return the constrained nodes: free ones, ascending. (Hanging nodes lie between them.)
  [[nodiscard]] virtual std::span<const NodeId> nodes() const = 0;
  [[nodiscard]] virtual Gap gap(const Vec3& position) const = 0;

  [[nodiscard]] virtual std::unique_ptr<Obstacle> after_change(const Tissue& tissue,
                                                               const TissueChange& change) const = 0;

  /// Return the shape of a shell around the tissue; null for others.
  [[nodiscard]] virtual const OuterShape* shell() const { return nullptr; }
};

/// Nodes of all obstacles of a model, obstacle by obstacle: the layout of State::obstacle_forces and on_obstacle. A
/// node of several obstacles occurs several times.
class ObstacleContacts {
 public:
  explicit ObstacleContacts(const Model& model);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] NodeId node(std::size_t contact) const { return nodes_[contact]; }
  /// Return the gap of that contact; `positions` are those of all nodes. The last answer is cached, since a step asks
  /// several times per place and a measured shell takes microseconds. Only one thread at a time may ask about a
  /// contact.
  [[nodiscard]] Obstacle::Gap gap(std::size_t contact, std::span<const Vec3> positions) const;

  /// Number of nodes with contacts, and the contacts of each, by ascending node.
  [[nodiscard]] std::size_t node_count() const { return starts_.size() - 1; }
  [[nodiscard]] std::span<const std::size_t> at_node(std::size_t place) const {
    return std::span(by_node_).subspan(starts_[place], starts_[place + 1] - starts_[place]);
  }
  /// Return all contacts of the node of this contact.
  [[nodiscard]] std::span<const std::size_t> beside(std::size_t contact) const { return at_node(place_[contact]); }

 private:
  std::vector<NodeId> nodes_;               // contacts
  std::vector<const Obstacle*> obstacles_;  // contacts
  std::vector<std::size_t> place_;          // contacts: index among nodes with contacts
  std::vector<std::size_t> by_node_;        // contacts, sorted by node
  std::vector<std::size_t> starts_;         // node_count + 1, in by_node_

  struct CachedGap {
    Vec3 position;
    Obstacle::Gap gap;
  };
  mutable std::vector<std::optional<CachedGap>> last_;  // contacts
};

}  // namespace plica
