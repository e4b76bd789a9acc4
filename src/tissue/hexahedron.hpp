// The trilinear hexahedron: shape functions, volume and its derivatives, quality. Nodes in VTK's order: 0-3 one face
// counter-clockwise seen from the other, 4-7 above them.
#pragma once

#include <array>

#include "core/vector.hpp"

namespace plica {

using HexPoints = std::array<Vec3, 8>;  // um

/// Reference coordinates (-1 or 1) of the eight nodes.
extern const std::array<Vec3, 8> hex_reference_nodes;

/// The twelve edges as pairs of local nodes: 0-3 along u (0-1, 3-2, 4-5, 7-6), 4-7 along v (0-3, 1-2, 4-7, 5-6),
/// 8-11 along w (0-4, 1-5, 2-6, 3-7).
extern const std::array<std::array<int, 2>, 12> hex_edges;

/// The six faces in VTK's order (-u, +u, -v, +v, -w, +w), counter-clockwise seen from outside.
extern const std::array<std::array<int, 4>, 6> hex_faces;

/// Values N_i of the eight trilinear shape functions at reference coordinates in [-1, 1]^3.
std::array<double, 8> hex_shape(const Vec3& reference);

/// Gradients dN_i/d(reference) of the shape functions.
std::array<Vec3, 8> hex_shape_gradients(const Vec3& reference);

/// The part of a trilinear hexahedron between two places of it, given in [0, 1]^3: 0 and 1 its faces.
HexPoints hex_part(const HexPoints& points, const Vec3& low, const Vec3& high);

/// dx/d(reference), columns by reference direction.
Mat3 hex_jacobian(const HexPoints& points, const Vec3& reference);

/// Exact volume of the trilinear hexahedron, um^3; negative when it is inside out. A cubic polynomial of the points,
/// and the sum of a term per bilinear face that two cells share with opposite sign, so volumes of neighbours add up
/// exactly.
double hex_volume(const HexPoints& points);

/// dV/dx_i, um^2 (eight vectors). Satisfies sum_i x_i . dV/dx_i = 3 V.
std::array<Vec3, 8> hex_volume_gradient(const HexPoints& points);

/// d2V/dx_i dx_j as vectors a_ij with the 3 x 3 block [a_ij]x; antisymmetric: a_ji = -a_ij.
std::array<std::array<Vec3, 8>, 8> hex_volume_hessian(const HexPoints& points);

/// det J at the eight corners, um^3.
std::array<double, 8> hex_corner_jacobians(const HexPoints& points);

/// Smallest det J over the eight corners, each divided by the product of its three edge lengths: 1 for a brick, at most
/// 0 when a corner is flat or inverted. (The usual "scaled Jacobian".)
double hex_scaled_jacobian(const HexPoints& points);

/// Whether that is positive: no corner inside out or flat.
bool hex_is_upright(const HexPoints& points);

/// Area of the bilinear facet through four points, um^2 (2 x 2 Gauss points).
double facet_area(const std::array<Vec3, 4>& points);

/// The facet's area vector (outward for counter-clockwise order), um^2; exact.
Vec3 facet_area_vector(const std::array<Vec3, 4>& points);

/// The area of the largest of its six faces.
double largest_face(const HexPoints& points);

}  // namespace plica
