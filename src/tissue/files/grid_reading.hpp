// Mesh files through VTK's readers.
//
// VTK's readers trust the numbers in a file: a few damaged bytes make them divide by zero or write beyond their memory.
// So a child process reads the file and hands over what it found as bytes, and plica lives on whatever VTK does. There
// a window of our own takes what VTK has to say, also from objects within its readers. Any error counts, since VTK
// hands out what it has got of a broken file as if it were whole.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tissue/hexahedral_mesh.hpp"

template <class Object>
class vtkSmartPointer;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace plica {

/// FileError: `FILE: cannot be read: WHY`.
[[noreturn]] void throw_unread(const std::filesystem::path& file, const std::string& why);

/// What `read` returns, run in a child process. Its FileError and MeshError come out here; FileError when it crashed.
std::string read_in_child(const std::filesystem::path& file, const std::function<std::string()>& read);

// To be called within `read` of read_in_child. All throw FileError when the file cannot be read.

/// An unstructured grid, XML or legacy, told by its content.
vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::filesystem::path& file);

/// The surface that a file holds, or the boundary of a volume mesh, split into triangles: VTK XML or legacy by content;
/// STL, PLY and OBJ by the file's ending.
vtkSmartPointer<vtkPolyData> read_triangles(const std::filesystem::path& file);

/// Nodes and cells of a grid of hexahedra. MeshError when it holds anything else, or its lists do not fit together.
void copy_hexahedra(vtkUnstructuredGrid& grid, Vectors& points, std::vector<std::array<NodeId, 8>>& hexahedra);

}  // namespace plica
