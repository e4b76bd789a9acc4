// Base of ShapeMemory and of laws in tests: a frame that rotates with each element, and the transformation of forces
// and tangents in that frame. Derivation: docs/theory/corotational.md, Frame, Force and Tangent.
//
// A law gives its element eight frame vectors b_i; the frame is the rotation R nearest to sum_i x_i b_i^T = R S. In it
// the local displacement is u_i = R^T (x_i - c) - (X_i - C), and the law is an energy of u. R is differentiated too:
// forces are exact gradients, without resultant or torque for any b_i, and tangents are exact and symmetric.
#pragma once

#include <Eigen/Dense>

#include "mechanics/elasticity/hexahedron_stiffness.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Return the rotation R nearest to F and the symmetric S = R^T F.
void polar(const Mat3& F, Mat3& R, Mat3& S);

/// Throw std::domain_error, naming the element, if a rest shape of `tissue` is inverted or flat.
void require_upright_rest_shapes(const Tissue& tissue);

/// Laws whose energy is a function of each element's local displacement.
class TurningElements : public Law {
 public:
  [[nodiscard]] double energy(const Step& step) const final;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const final;
  void add_forces(const Step& step, std::span<Vec3> forces) const final;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const final;
  void add_tangent(const Step& step, TangentSink& tangent) const final;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const final;

 protected:
  struct Element {
    std::array<NodeId, 8> nodes;
    std::array<Vec3, 8> frame;  // b_i; sum to zero
    HexPoints rest;             // X_i - C
    Mat24 viscosity;            // used only if the law is viscous
  };

  /// Make elements with the nodes of `tissue`; derived laws set rest shapes, frames and viscosities.
  TurningElements(const Tissue& tissue, bool viscous);

  /// Return the energy of local displacements u, nN um, and its gradient q, nN; independent of translations of u, so q
  /// sums to zero.
  virtual double respond(std::size_t element, const Vec24& u, Vec24& q) const = 0;

  /// Return its Hessian at u, nN/um: stored, or computed in `space`.
  virtual const Mat24& local_stiffness(std::size_t element, const Vec24& u, Mat24& space) const = 0;

  /// Set the centred rest shape of an element.
  void take_rest_shape(const Tissue& tissue, std::size_t element);

  std::vector<Element> elements_;

 private:
  void add_warped_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const;
  struct Frame;  // rotation, local displacement and local force of an element at given positions
  [[nodiscard]] Frame frame(std::size_t e, const Step& step) const;

  ElementChunks chunks_;
  bool viscous_ = false;
};

}  // namespace plica
