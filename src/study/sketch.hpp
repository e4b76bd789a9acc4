// Pictures of a frame without a screen: the apical surface painted from back to front, and sections by a plane.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/svg.hpp"
#include "tissue/frame_file.hpp"

namespace plica {

/// Values to colours: from `low` (dark blue) over green to `high` (yellow), the viridis map.
struct ColourScale {
  std::string label;  // with its unit
  double low = 0, high = 1;
};

/// From where the body is seen.
struct Viewpoint {
  Vec3 from;  // from the body towards the eye; any length
  Vec3 up;    // what points up in the picture; need not be orthogonal
};

Viewpoint ventral_view();         // from below, anterior to the left
Viewpoint antero_ventral_view();  // from below and in front
Viewpoint side_view();            // from the left side, anterior to the left

/// Length of the displacement of each node, um.
std::vector<double> displacements(const Frame& frame);

/// The apical surface, flat-shaded; facets are coloured by the mean of their nodes' values. `um_per_pixel` is the
/// scale.
Svg sketch_surface(const Frame& frame, const std::vector<double>& node_values, const ColourScale& scale,
                   const Viewpoint& view, double um_per_pixel);

/// The section by the plane `axis` = `at` (um): each element that it meets as a polygon. With axis x it is seen from
/// the front, with y from the left side; the belly is below.
Svg sketch_section(const Frame& frame, const std::vector<double>& node_values, const ColourScale& scale, int axis,
                   double at, double um_per_pixel);

/// Pictures beside each other, `columns` a row, each under its heading, and the scale's colour bar below.
Svg strip(const std::vector<std::pair<std::string, Svg>>& pictures, std::size_t columns, const ColourScale& scale);

}  // namespace plica
