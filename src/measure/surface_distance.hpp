// How far points lie from a surface of triangles.
#pragma once

#include <memory>

#include "tissue/files/frame_file.hpp"

namespace plica {

/// Exact distances to the triangles of a surface (inside them, or to their edges and corners), found by a search tree.
/// FileError when plica was built without VTK.
class SurfaceDistance {
 public:
  explicit SurfaceDistance(const TriangleSurface& surface);  // at least one triangle
  ~SurfaceDistance();

  /// From the point to the nearest triangle, um; never negative.
  [[nodiscard]] double from(const Vec3& point) const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace plica
