// Two roofs whose ridges cross between all points: what only contact of edges keeps apart.
#pragma once

#include "mechanics/contact/self_contact.hpp"
#include "support/bodies.hpp"
#include "support/elements.hpp"
#include "support/models.hpp"

namespace plica::support {

/// Two cells each, whose apical faces are the two sides of a roof: a lower one along x with its ridge at z = 0, and one
/// `gap` above it, upside down, along y. All points of either are 5 um or more from the other's ridge.
struct Roofs {
  static constexpr double ridge = 40, slope = 10, height = 30;  // um: lengths and heights of the ridges, half widths
  static constexpr double aside = 5;                            // um: where they cross, from the middle of either

  Bodies bodies;
  std::size_t upper;  // its first node

  /// `parts`: into how many cells the lower one is divided along its ridge.
  explicit Roofs(double gap, int parts = 1) {
    bodies.add({parts, 2, 1}, [parts](int i, int j, int k) {
      const double y = slope * (j - 1);
      return Vec3(ridge * (static_cast<double>(i) / parts - 0.5), y, k == 1 ? -std::abs(y) : -height);
    });
    upper = bodies.add({1, 2, 1}, [&](int i, int j, int k) {
      const double x = slope * (j - 1);
      return Vec3(x + aside, ridge * (i - 0.5) - aside, gap + (k == 1 ? std::abs(x) : height));
    });
  }
};

/// Soft ones in a fluid, the lower one held at its bottom; contact is the last law.
inline Model model_of(const Roofs& roofs, const SelfContactRule& rule) {
  Model model(roofs.bodies.tissue());
  model.volumes.hold(false);
  const ElasticModuli soft = ElasticModuli::from_young(0.3, 0.3);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, in_elements(model.tissue, soft), 0));
  model.laws.push_back(
      std::make_unique<Dilatation>(model.tissue, in_elements(model.tissue, soft.bulk_modulus()), false));
  add_drag(model);
  model.laws.push_back(std::make_unique<SelfContact>(model.tissue, rule));
  for (std::size_t n = 0; n < roofs.upper; ++n)
    if (model.tissue.rest_positions[n].z() < 1e-9 - Roofs::height) model.held[n] = {true, true, true};
  return model;
}

/// The pairs of edges of an internal state of contact.
inline std::vector<ContactPair> edges_of(std::span<const double> internal) {
  const std::span<const ContactPair> all = SelfContact::pairs_of(internal);
  std::vector<ContactPair> pairs(all.begin(), all.end());
  std::erase_if(pairs, [](const ContactPair& pair) { return !pair.is_of_edges(); });
  return pairs;
}

}  // namespace plica::support
