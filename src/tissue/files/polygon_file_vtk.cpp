#include <fmt/format.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include "core/bytes.hpp"
#include "core/one_thread_vtk.hpp"
#include "tissue/files/grid_reading.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

bool is_polygon(int type) {
  return type == VTK_POLYGON || type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_PIXEL;
}

/// Faces of the grid: points and lines are passed over.
std::vector<vtkIdType> faces_of_grid(vtkDataSet& grid) {
  if (grid.GetNumberOfCells() > largest_mesh_elements)
    throw MeshError(fmt::format("the surface has {} faces; at most {} are allowed", grid.GetNumberOfCells(),
                                largest_mesh_elements));
  std::vector<vtkIdType> faces;
  for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
    const int type = grid.GetCellType(cell);
    if (is_polygon(type)) faces.push_back(cell);
    if (is_polygon(type) || type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE || type == VTK_POLY_LINE)
      continue;
    throw MeshError(fmt::format("cell {} is a {} (VTK type {}); a surface consists of polygons{}", cell,
                                vtkCellTypes::GetClassNameFromTypeId(type), type,
                                type == VTK_HEXAHEDRON ? "; for hexahedra, set embryo.shape to \"file\""
                                                       : ": extract the apical faces, by Extract Surface in ParaView"));
  }
  return faces;
}

/// Serialise the polygons in the child process.
std::string polygon_bytes(const std::filesystem::path& path) {
  const vtkSmartPointer<vtkDataSet> grid = read_data_set(path);
  const std::vector<vtkIdType> faces = faces_of_grid(*grid);
  Vectors points(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) grid->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  std::vector<std::size_t> counts, corners;
  vtkNew<vtkIdList> ids;
  for (const vtkIdType face : faces) {
    grid->GetCellPoints(face, ids);
    if (grid->GetCellType(face) == VTK_PIXEL && ids->GetNumberOfIds() == 4) {
      const vtkIdType third = ids->GetId(2);  // a pixel goes line by line
      ids->SetId(2, ids->GetId(3));
      ids->SetId(3, third);
    }
    counts.push_back(static_cast<std::size_t>(ids->GetNumberOfIds()));
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) {
      if (ids->GetId(k) < 0 || ids->GetId(k) >= grid->GetNumberOfPoints())
        throw MeshError(fmt::format("face {} uses vertex {}; there are {}", counts.size() - 1, ids->GetId(k),
                                    grid->GetNumberOfPoints()));
      corners.push_back(static_cast<std::size_t>(ids->GetId(k)));
    }
  }
  std::string bytes;
  put(points, bytes);
  put(counts, bytes);
  put(corners, bytes);
  for (int a = 0; a < grid->GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid->GetCellData()->GetArray(a);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) continue;
    if (array->GetNumberOfTuples() != grid->GetNumberOfCells())
      throw MeshError(fmt::format("the array \"{}\" has {} values for {} cells", array->GetName(),
                                  array->GetNumberOfTuples(), grid->GetNumberOfCells()));
    CellArray values;
    for (const vtkIdType face : faces) values.push_back(array->GetComponent(face, 0));
    put(std::string(array->GetName()), bytes);
    put(values, bytes);
  }
  return bytes;
}

}  // namespace

PolygonFile read_vtk_polygons(const std::filesystem::path& path) {
  const std::string bytes = read_in_child(path, [&] { return polygon_bytes(path); });
  std::string_view rest = bytes;
  PolygonFile file;
  file.surface.vertices = take<Vectors>(rest);
  const auto counts = take<std::vector<std::size_t>>(rest), corners = take<std::vector<std::size_t>>(rest);
  auto next = corners.begin();
  for (const std::size_t count : counts) {
    file.surface.polygons.emplace_back(next, next + static_cast<std::ptrdiff_t>(count));
    next += static_cast<std::ptrdiff_t>(count);
  }
  while (!rest.empty()) {
    const auto name = take<std::string>(rest);
    file.arrays[name] = take<CellArray>(rest);
  }
  return file;
}

}  // namespace plica
