// Trilinear hexahedron: shape functions, volume and its derivatives, quality. Nodes in VTK order: 0-3 one face,
// counter-clockwise seen from the other, 4-7 above them.
#pragma once

#include <array>

#include "core/vector.hpp"

namespace plica {

using HexPoints = std::array<Vec3, 8>;  // um

/// Reference coordinates (-1 or 1) of the eight nodes.
extern const std::array<Vec3, 8> hex_reference_nodes;

/// Twelve edges as pairs of local nodes: 0-3 along u (0-1, 3-2, 4-5, 7-6), 4-7 along v (0-3, 1-2, 4-7, 5-6), 8-11 along
/// w (0-4, 1-5, 2-6, 3-7).
extern const std::array<std::array<int, 2>, 12> hex_edges;

/// Six faces in VTK order (-u, +u, -v, +v, -w, +w), counter-clockwise seen from outside.
extern const std::array<std::array<int, 4>, 6> hex_faces;

/// Return values N_i of the eight trilinear shape functions at reference coordinates in [-1, 1]^3.
std::array<double, 8> hex_shape(const Vec3& reference);

/// Return gradients dN_i/d(reference) of the shape functions.
std::array<Vec3, 8> hex_shape_gradients(const Vec3& reference);

/// Return the part of a trilinear hexahedron between two places in [0, 1]^3, where 0 and 1 are its faces.
HexPoints hex_part(const HexPoints& points, const Vec3& low, const Vec3& high);

/// Return dx/d(reference), columns by reference direction.
Mat3 hex_jacobian(const HexPoints& points, const Vec3& reference);

/// Return the exact volume, um^3; negative if inverted. A cubic polynomial of the points, and a sum of terms per
/// bilinear face with opposite sign in both adjacent cells, so volumes of neighbours add up exactly.
double hex_volume(const HexPoints& points);

/// Return dV/dx_i, um^2 (eight vectors). Satisfies sum_i x_i . dV/dx_i = 3 V.
std::array<Vec3, 8> hex_volume_gradient(const HexPoints& points);

/// Return d2V/dx_i dx_j as vectors a_ij with the 3 x 3 block [a_ij]x; antisymmetric: a_ji = -a_ij.
std::array<std::array<Vec3, 8>, 8> hex_volume_hessian(const HexPoints& points);

/// Return det J at the eight corners, um^3.
std::array<double, 8> hex_corner_jacobians(const HexPoints& points);

/// Return the scaled Jacobian: smallest det J over the eight corners, each divided by the product of its three edge
/// lengths; 1 for a brick, <= 0 if a corner is flat or inverted.
double hex_scaled_jacobian(const HexPoints& points);

/// Whether the scaled Jacobian is positive: no corner inverted or flat.
bool hex_is_upright(const HexPoints& points);

/// Return the area of the bilinear facet through four points, um^2 (2 x 2 Gauss points).
double facet_area(const std::array<Vec3, 4>& points);

/// Return dA/dx_i of that area, um (four vectors).
std::array<Vec3, 4> facet_area_gradient(const std::array<Vec3, 4>& points);

/// Return the area vector of the facet (outward for counter-clockwise order), um^2; exact.
Vec3 facet_area_vector(const std::array<Vec3, 4>& points);

/// Return the area of the largest of its six faces.
double largest_face(const HexPoints& points);

}  // namespace plica
