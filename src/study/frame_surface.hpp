// Apical and basal surfaces of a snapshot, and distances between surfaces.
#pragma once

#include <array>
#include <vector>

#include "measure/surface_distance.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

using Quads = std::vector<std::array<NodeId, 4>>;

/// Boundary faces on the apical (nodes 4-7) or basal (nodes 0-3) side of the elements, oriented outward. Throws
/// MeshError for an inconsistent mesh.
Quads apical_facets(const Frame& frame);
Quads basal_facets(const Frame& frame);

/// Area of bilinear facets, um^2.
double total_area(const Frame& frame, const Quads& facets);

/// Triangulate bilinear facets: 8 x 8 pieces each, with four triangles about the middle of a piece. Corners lie on the
/// facet; triangles lie within `facet_error` of it.
TriangleSurface fine_triangles(const Frame& frame, const Quads& facets);

/// Largest distance between a facet and its triangles, um: |twist| / 1024 with twist = x0 - x1 + x2 - x3.
double facet_error(const Frame& frame, const Quads& facets);

/// Statistics of distances: mean, root mean square, maximum; um.
struct Distances {
  double mean = 0, rms = 0, max = 0;
};

/// Distances from a surface to another. Mean and rms: over the centres of 4 x 4 parts of each facet, weighted by area;
/// maximum: over these and the corners of the parts, 41 points per facet.
Distances distances_to(const SurfaceDistance& other, const Frame& frame, const Quads& facets);

/// Distance of each node from another snapshot: apical nodes from its apical surface, basal nodes from its basal
/// surface; other nodes take the mean of their neighbours in their elements.
std::vector<double> node_distances(const Frame& frame, const Frame& other);

}  // namespace plica
