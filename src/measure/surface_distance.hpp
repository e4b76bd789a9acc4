// Distance of points from a triangulated surface.
#pragma once

#include <memory>

#include "tissue/files/frame_file.hpp"

namespace plica {

/// Exact distances to the triangles of a surface, by a search tree. Throws FileError in builds without VTK.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const TriangleSurface& surface);  // at least one triangle
  ~SurfaceDistance();

  /// Distance from a point to the nearest triangle, um; >= 0.
  [[nodiscard]] double from(const Vec3& point) const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace plica
