// What nodes cannot pass: a shell around the embryo, a plane, another surface.
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

/// Keeps gaps g(x) >= 0 of some nodes, without friction or sticking: a node in contact is pushed along dg/dx, a node
/// that is not is left alone.
class Obstacle {
 public:
  /// A node's gap (positive where it may be, um), its gradient (of length 1) and Hessian (1/um).
  using Gap = OuterShape::Gap;

  virtual ~Obstacle() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Obstacle> clone() const = 0;

  /// The nodes that it keeps: free ones, in ascending order. (What hangs lies between them.)
  [[nodiscard]] virtual std::span<const NodeId> nodes() const = 0;
  [[nodiscard]] virtual Gap gap(const Vec3& position) const = 0;

  /// The same for the tissue after a division.
  [[nodiscard]] virtual std::unique_ptr<Obstacle> after_division(const Tissue& tissue,
                                                                 const Division& division) const = 0;
};

/// The nodes of all obstacles of a model, one obstacle after the other: what State::contact_forces and in_contact are
/// of. A node that several obstacles keep is there several times.
class Contacts {
 public:
  explicit Contacts(const Model& model);

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] NodeId node(std::size_t contact) const { return nodes_[contact]; }
  /// The gap of that node, here among all nodes' positions. A step asks several times for each place, and a measured
  /// shell takes microseconds to answer: so the last answer is kept. One contact is asked about by one thread at a
  /// time.
  [[nodiscard]] Obstacle::Gap gap(std::size_t contact, std::span<const Vec3> positions) const;

  /// The contacts of each node that has any, by ascending node.
  [[nodiscard]] std::size_t node_count() const { return starts_.size() - 1; }
  [[nodiscard]] std::span<const std::size_t> at_node(std::size_t place) const {
    return std::span(by_node_).subspan(starts_[place], starts_[place + 1] - starts_[place]);
  }
  /// The contacts of the node of this one.
  [[nodiscard]] std::span<const std::size_t> beside(std::size_t contact) const { return at_node(place_[contact]); }

 private:
  std::vector<NodeId> nodes_;               // contacts
  std::vector<const Obstacle*> obstacles_;  // contacts
  std::vector<std::size_t> place_;          // contacts: which of the nodes that have any
  std::vector<std::size_t> by_node_;        // contacts, sorted by node
  std::vector<std::size_t> starts_;         // node_count + 1, in by_node_

  struct Answer {
    Vec3 position;
    Obstacle::Gap gap;
  };
  mutable std::vector<std::optional<Answer>> last_;  // contacts
};

}  // namespace plica
