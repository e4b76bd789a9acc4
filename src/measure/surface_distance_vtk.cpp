#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include "core/one_thread_vtk.hpp"
#include "measure/surface_distance.hpp"

namespace plica {

struct SurfaceDistance::Search {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkStaticCellLocator> locator;
  vtkNew<vtkGenericCell> cell;  // scratch of the locator
};

SurfaceDistance::SurfaceDistance(const TriangleSurface& surface) : search_(std::make_unique<Search>()) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& point : surface.points) points->InsertNextPoint(point.data());
  vtkNew<vtkCellArray> triangles;
  for (const std::array<int, 3>& triangle : surface.triangles) {
    const std::array<vtkIdType, 3> ids = {triangle[0], triangle[1], triangle[2]};
    triangles->InsertNextCell(3, ids.data());
  }
  search_->surface->SetPoints(points);
  search_->surface->SetPolys(triangles);
  search_->locator->SetDataSet(search_->surface);
  search_->locator->BuildLocator();
}

SurfaceDistance::~SurfaceDistance() = default;

double SurfaceDistance::from(const Vec3& point) const {
  Vec3 nearest = point;
  vtkIdType triangle = -1;
  int part = 0;
  double squared_distance = 0;
  search_->locator->FindClosestPoint(point.data(), nearest.data(), search_->cell, triangle, part, squared_distance);
  return (nearest - point).norm();
}

}  // namespace plica
