// The apical and basal surfaces of a frame, and how far one surface lies from another.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "measure/surface_distance.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

using Quads = std::vector<std::array<NodeId, 4>>;

/// The faces of the elements' apical (nodes 4-7) or basal (nodes 0-3) side that no other element shares: outward.
/// MeshError when the elements do not fit together.
Quads apical_facets(const Frame& frame);
Quads basal_facets(const Frame& frame);

/// Area of bilinear facets, um^2.
double total_area(const Frame& frame, const Quads& facets);

/// Bilinear facets, each cut into 8 x 8 pieces and these into four triangles about their middle. Corners of triangles
/// lie on the facet; triangles lie within `facet_error` of it.
TriangleSurface fine_triangles(const Frame& frame, const Quads& facets);

/// Largest distance between a facet and its triangles, um: |twist| / 1024 with twist = x0 - x1 + x2 - x3.
double facet_error(const Frame& frame, const Quads& facets);

/// How far something lies away: mean, root of the mean square, largest; um.
struct Distances {
  double mean = 0, rms = 0, max = 0;
};

/// From one surface to another. Mean and rms are over the middles of 4 x 4 parts of each facet, weighed by area; the
/// largest is over these and the parts' corners, 41 points a facet.
Distances distances_to(const SurfaceDistance& other, const Frame& frame, const Quads& facets);

/// Each node's distance from the same side of another frame: of apical nodes from its apical surface, of basal nodes
/// from its basal one; a node between them has the mean of its neighbours' values in its elements.
std::vector<double> node_distances(const Frame& frame, const Frame& other);

}  // namespace plica
