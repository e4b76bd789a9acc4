#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/one_thread_vtk.hpp"
#include "tissue/files/grid_reading.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

std::vector<int> apical_faces(vtkDataArray& array, const std::vector<long long>& cells) {
  std::vector<int> faces;
  for (const vtkIdType cell : cells) {
    const double value = array.GetComponent(cell, 0);
    if (!(value >= 0 && value <= 5 && value == std::floor(value)))
      throw MeshError("the apical face of cell {} is {} in \"{}\"; faces are 0 to 5", cell, value, array.GetName());
    faces.push_back(static_cast<int>(value));
  }
  return faces;
}

/// Arrays of one number per cell of the grid; MeshError if one has another length.
void for_cell_arrays(vtkDataSet& grid, const std::function<void(const std::string& name, vtkDataArray&)>& take) {
  for_arrays(*grid.GetCellData(), 1, [&](const std::string& name, vtkDataArray& array) {
    if (array.GetNumberOfTuples() != grid.GetNumberOfCells())
      throw MeshError("the cell array \"{}\" has {} values for {} cells", name, array.GetNumberOfTuples(),
                      grid.GetNumberOfCells());
    take(name, array);
  });
}

/// Copies the arrays, NaN where they are not finite; one names the faces that are apical.
void copy_arrays(vtkUnstructuredGrid& grid, const std::vector<long long>& cells, const std::string& apical_array,
                 HexahedralMesh& mesh) {
  std::vector<std::string> names;
  for_cell_arrays(grid, [&](const std::string& name, vtkDataArray& array) {
    names.push_back(name);
    if (name == apical_array) {
      mesh.apical_faces = apical_faces(array, cells);
      return;
    }
    CellArray& values = mesh.arrays[name];
    for (const vtkIdType cell : cells) {
      const double value = array.GetComponent(cell, 0);
      values.push_back(std::isfinite(value) ? value : std::nan(""));
    }
  });
  if (!apical_array.empty() && mesh.apical_faces.empty())
    throw MeshError("no cell array \"{}\" with one number per cell; there {}", apical_array,
                    names.empty() ? "are none" : fmt::format("are: {}", fmt::join(names, ", ")));
}

std::vector<int> whole_numbers(vtkDataArray* array) {
  std::vector<int> numbers;
  if (array == nullptr) return numbers;
  const vtkIdType components = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < array->GetNumberOfTuples() * components; ++i) {
    const double value = array->GetComponent(i / components, static_cast<int>(i % components));
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
      throw MeshError("\"{}\" contains {}; values must be whole numbers", array->GetName(), value);
    numbers.push_back(static_cast<int>(value));
  }
  return numbers;
}

/// Cells of several hexahedra are given by the array cell_id, or by the lists beside the grid.
void copy_groups(vtkUnstructuredGrid& grid, HexahedralMesh& mesh) {
  const auto list = [&](const char* name) { return whole_numbers(grid.GetFieldData()->GetArray(name)); };
  CellGroups groups{
      {}, list("elements_per_cell"), list("cell_corner_counts"), list("cell_corners"), list("hanging_nodes")};
  const bool is_told = !groups.elements_per_cell.empty() || !groups.corner_counts.empty();
  const auto id = mesh.arrays.find("cell_id");
  if (id == mesh.arrays.end()) {
    if (is_told) throw MeshError("the file lists the corners of its cells but has no cell array cell_id");
    return;
  }
  const std::set<double> cells(id->second.begin(), id->second.end());
  if (!is_told && cells.size() == mesh.cells.size()) return;
  if (!is_told)
    throw MeshError(
        "the array cell_id joins {} hexahedra to {} cells without their corners; add the field arrays "
        "cell_corner_counts and cell_corners, as `plica mesh` writes them, or remove cell_id if each hexahedron is a "
        "cell",
        mesh.cells.size(), cells.size());
  if (mesh.cells.size() != static_cast<std::size_t>(grid.GetNumberOfCells()))
    throw MeshError("cells of several hexahedra leave no room for other cells; remove faces and lines from the file");
  groups.cell_of = whole_numbers(grid.GetCellData()->GetArray("cell_id"));
  mesh.groups = std::move(groups);
}

HexahedralMesh mesh_in(const std::filesystem::path& file, const std::string& apical_array) {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(file);
  GridHexahedra found = hexahedra_of(*grid);
  HexahedralMesh mesh;
  mesh.points = std::move(found.points);
  mesh.cells = std::move(found.hexahedra);
  if (!found.remark.empty()) mesh.remarks.push_back(std::move(found.remark));
  if (!mesh.cells.empty()) {
    copy_arrays(*grid, found.cells, apical_array, mesh);
    copy_groups(*grid, mesh);
  }
  return mesh;
}

bool is_polygon(int type) {
  return type == VTK_POLYGON || type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_PIXEL;
}

/// Faces of the grid: points and lines are passed over.
std::vector<vtkIdType> faces_of_grid(vtkDataSet& grid) {
  if (grid.GetNumberOfCells() > largest_mesh_elements)
    throw MeshError("the surface has {} faces; at most {} are allowed", grid.GetNumberOfCells(), largest_mesh_elements);
  std::vector<vtkIdType> faces;
  for (vtkIdType cell = 0; cell < grid.GetNumberOfCells(); ++cell) {
    const int type = grid.GetCellType(cell);
    if (is_polygon(type)) faces.push_back(cell);
    if (is_polygon(type) || type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE || type == VTK_POLY_LINE)
      continue;
    throw MeshError("cell {} is a {} (VTK type {}); a surface consists of polygons{}", cell,
                    vtkCellTypes::GetClassNameFromTypeId(type), type,
                    type == VTK_HEXAHEDRON ? "; for hexahedra, set embryo.shape to \"file\""
                                           : ": extract the apical faces, by Extract Surface in ParaView");
  }
  return faces;
}

PolygonFile polygons_in(const std::filesystem::path& path) {
  const vtkSmartPointer<vtkDataSet> grid = read_data_set(path);
  const std::vector<vtkIdType> faces = faces_of_grid(*grid);
  PolygonFile file;
  file.surface.vertices = points_of(*grid);
  vtkNew<vtkIdList> ids;
  for (const vtkIdType face : faces) {
    grid->GetCellPoints(face, ids);
    if (grid->GetCellType(face) == VTK_PIXEL && ids->GetNumberOfIds() == 4) {
      const vtkIdType third = ids->GetId(2);  // a pixel goes line by line
      ids->SetId(2, ids->GetId(3));
      ids->SetId(3, third);
    }
    auto& polygon = file.surface.polygons.emplace_back();
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) {
      if (ids->GetId(k) < 0 || ids->GetId(k) >= grid->GetNumberOfPoints())
        throw MeshError("face {} uses vertex {}; there are {}", file.surface.polygons.size() - 1, ids->GetId(k),
                        grid->GetNumberOfPoints());
      polygon.push_back(static_cast<std::size_t>(ids->GetId(k)));
    }
  }
  for_cell_arrays(*grid, [&](const std::string& name, vtkDataArray& array) {
    for (const vtkIdType face : faces) file.arrays[name].push_back(array.GetComponent(face, 0));
  });
  return file;
}

}  // namespace

HexahedralMesh read_vtk_hexahedra(const std::filesystem::path& file, const std::string& apical_array) {
  return read_in_child(file, [&] { return mesh_in(file, apical_array); });
}

PolygonFile read_vtk_polygons(const std::filesystem::path& path) {
  return read_in_child(path, [&] { return polygons_in(path); });
}

}  // namespace plica
