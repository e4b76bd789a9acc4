// Mesh files through VTK's readers.
//
// VTK's readers trust the numbers in a file: a few damaged bytes make them divide by zero or write beyond their memory.
// So a child process reads the file (child_reading.hpp). There a window of our own takes what VTK has to say, also from
// objects within its readers. Any error counts, since VTK hands out what it has got of a broken file as if it were
// whole.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "tissue/files/child_reading.hpp"
#include "tissue/hexahedral_mesh.hpp"

template <class Object>
class vtkSmartPointer;
class vtkDataSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace plica {

// To be called within `read` of read_in_child. All throw FileError when the file cannot be read.

/// An unstructured grid, XML or legacy, told by its content.
vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file);

/// What a VTK file holds, XML or legacy, told by its content: points and cells of any kind.
vtkSmartPointer<vtkDataSet> read_data_set(const std::filesystem::path& file);

/// The surface that a file holds, or the boundary of a volume mesh, split into triangles: VTK XML or legacy by content;
/// STL, PLY and OBJ by the file's ending.
vtkSmartPointer<vtkPolyData> read_triangles(const std::filesystem::path& file);

/// Nodes and cells of a grid of hexahedra. MeshError when it holds anything else, or its lists do not fit together.
void copy_hexahedra(vtkUnstructuredGrid& grid, Vectors& points, std::vector<std::array<NodeId, 8>>& hexahedra);

}  // namespace plica
