#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/one_thread_vtk.hpp"
#include "tissue/files/child_reading.hpp"
#include "tissue/files/grid_reading.hpp"
#include "tissue/files/mesh_file.hpp"

namespace plica {
namespace {

std::vector<int> apical_faces(vtkDataArray& array, const std::vector<long long>& cells) {
  std::vector<int> faces;
  for (const vtkIdType cell : cells) {
    const double value = array.GetComponent(cell, 0);
    if (!(value >= 0 && value <= 5 && value == std::floor(value)))
      throw MeshError(
          fmt::format("the apical face of cell {} is {} in \"{}\"; faces are 0 to 5", cell, value, array.GetName()));
    faces.push_back(static_cast<int>(value));
  }
  return faces;
}

/// Arrays of one number a cell, NaN where it is not finite; one names the faces that are apical.
void copy_arrays(vtkUnstructuredGrid& grid, const std::vector<long long>& cells, const std::string& apical_array,
                 HexahedralMesh& mesh) {
  std::string names;
  for (int a = 0; a < grid.GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid.GetCellData()->GetArray(a);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) continue;
    const std::string name = array->GetName();
    if (array->GetNumberOfTuples() != grid.GetNumberOfCells())
      throw MeshError(fmt::format("the cell array \"{}\" has {} values for {} cells", name, array->GetNumberOfTuples(),
                                  grid.GetNumberOfCells()));
    names += names.empty() ? name : ", " + name;
    if (name == apical_array) {
      mesh.apical_faces = apical_faces(*array, cells);
      continue;
    }
    CellArray& values = mesh.arrays[name];
    for (const vtkIdType cell : cells) {
      const double value = array->GetComponent(cell, 0);
      values.push_back(std::isfinite(value) ? value : std::nan(""));
    }
  }
  if (!apical_array.empty() && mesh.apical_faces.empty())
    throw MeshError(fmt::format("no cell array \"{}\" with one number per cell; there {}", apical_array,
                                names.empty() ? "are none" : "are: " + names));
}

std::vector<int> whole_numbers(vtkDataArray* array) {
  std::vector<int> numbers;
  if (array == nullptr) return numbers;
  const vtkIdType components = array->GetNumberOfComponents();
  for (vtkIdType i = 0; i < array->GetNumberOfTuples() * components; ++i) {
    const double value = array->GetComponent(i / components, static_cast<int>(i % components));
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
      throw MeshError(fmt::format("\"{}\" contains {}; values must be whole numbers", array->GetName(), value));
    numbers.push_back(static_cast<int>(value));
  }
  return numbers;
}

/// Whose cells have several hexahedra, the array cell_id tells, or the lists beside the grid.
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
    throw MeshError(fmt::format(
        "the array cell_id joins {} hexahedra to {} cells without their corners; add the field arrays "
        "cell_corner_counts and cell_corners, as `plica mesh` writes them, or remove cell_id if each hexahedron is a "
        "cell",
        mesh.cells.size(), cells.size()));
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

/// Serialise the mesh and its remarks in the child process.
std::string bytes_of(const HexahedralMesh& mesh) {
  std::string bytes;
  put(fmt::format("{}", fmt::join(mesh.remarks, "\n")), bytes);
  return bytes + mesh_to_bytes(mesh);
}

}  // namespace

Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array, const MeshOptions& options) {
  try {
    const std::string bytes = read_in_child(file, [&] { return bytes_of(mesh_in(file, apical_array)); });
    std::string_view rest = bytes;
    const auto remark = take<std::string>(rest);
    HexahedralMesh mesh = mesh_from_bytes(rest);
    if (!remark.empty()) mesh.remarks.push_back(remark);
    return tissue_from_mesh(std::move(mesh), options);
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace plica
