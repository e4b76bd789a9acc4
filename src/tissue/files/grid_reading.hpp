// Mesh files through VTK's readers.
//
// VTK readers trust the numbers in a file: damaged bytes make them divide by zero or write out of bounds. So a child
// process reads the file (child_reading.hpp). A custom output window collects VTK messages, also from objects within
// readers. Any error counts, since VTK returns partial data of a broken file as if it were complete.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tissue/files/child_reading.hpp"
#include "tissue/mesh_input.hpp"

template <class Object>
class vtkSmartPointer;
class vtkDataArray;
class vtkDataSet;
class vtkDataSetAttributes;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace plica {

// Call these within `read` of read_in_child. All throw FileError if the file cannot be read.

/// Read an unstructured grid, XML or legacy by content.
vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file);

/// Read points and cells of any kind from a VTK file, XML or legacy by content.
vtkSmartPointer<vtkDataSet> read_data_set(const std::filesystem::path& file);

/// Read the surface in a file, or the boundary of a volume mesh, split into triangles: VTK XML or legacy by content;
/// STL, PLY and OBJ by extension.
vtkSmartPointer<vtkPolyData> read_triangles(const std::filesystem::path& file);

/// Return all points of a grid or surface.
Vectors points_of(vtkDataSet& data);

/// Call `take(name, array)` for each named array of `components` numbers per node or cell.
void for_arrays(vtkDataSetAttributes& data, int components,
                const std::function<void(const std::string& name, vtkDataArray&)>& take);

/// Hexahedra among the cells of a grid, which may also have faces, lines and vertices.
struct GridHexahedra {
  Vectors points;
  std::vector<std::array<NodeId, 8>> hexahedra;  // corners
  std::vector<long long> cells;                  // hexahedra: number in the grid
  std::string remark;                            // what was omitted; empty if nothing
};

/// Copy the hexahedra of a grid; of quadratic ones, only the corners. MeshError for other volumes or inconsistent
/// lists.
GridHexahedra hexahedra_of(vtkUnstructuredGrid& grid);

}  // namespace plica
