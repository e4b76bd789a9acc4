#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/one_thread_vtk.hpp"
#include "tissue/files/frame_file.hpp"
#include "tissue/files/grid_reading.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

void require_finite(const fs::path& file, const Vectors& vectors) {
  if (!std::ranges::all_of(vectors, [](const Vec3& v) { return v.allFinite(); }))
    throw_unread(file, "a coordinate is not finite");
}

/// Calls `take(name, array)` for each named array of `components` numbers a node or cell.
template <class Take>
void each_array(vtkDataSetAttributes& data, int components, std::size_t count, const Take& take) {
  for (int a = 0; a < data.GetNumberOfArrays(); ++a) {
    vtkDataArray* array = data.GetArray(a);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != components) continue;
    if (static_cast<std::size_t>(array->GetNumberOfTuples()) == count) take(std::string(array->GetName()), *array);
  }
}

/// Serialise a snapshot in the child process, for read_frame.
std::string frame_bytes(const fs::path& file) {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(file);
  const auto [points, elements, cells, remark] = hexahedra_of(*grid);
  std::vector<double> time;
  vtkDataArray* value = grid->GetFieldData()->GetArray("TimeValue");
  if (value != nullptr && value->GetNumberOfTuples() == 1) time.push_back(value->GetTuple1(0));
  const auto field = [&](const char* name) {
    std::vector<int> values;
    vtkDataArray* array = grid->GetFieldData()->GetArray(name);
    for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfTuples(); ++i)
      values.push_back(static_cast<int>(array->GetTuple1(i)));
    return values;
  };
  std::string bytes;
  put(points, bytes);
  put(elements, bytes);
  put(time, bytes);
  for (const char* name : {"polygon_ends", "polygon_apical", "polygon_basal", "polygon_elements"})
    put(field(name), bytes);
  std::string vectors, scalars;
  each_array(*grid->GetPointData(), 3, points.size(), [&](const std::string& name, vtkDataArray& array) {
    Vectors values(points.size());
    for (std::size_t n = 0; n < values.size(); ++n) array.GetTuple(static_cast<vtkIdType>(n), values[n].data());
    put(name, vectors);
    put(values, vectors);
  });
  const auto cell_count = static_cast<std::size_t>(grid->GetNumberOfCells());
  each_array(*grid->GetCellData(), 1, cell_count, [&, &cells = cells](const std::string& name, vtkDataArray& array) {
    std::vector<double> values;
    for (const vtkIdType cell : cells) values.push_back(array.GetTuple1(cell));
    put(name, scalars);
    put(values, scalars);
  });
  put(vectors, bytes);
  put(scalars, bytes);
  return bytes;
}

std::string surface_bytes(const fs::path& file) {
  const vtkSmartPointer<vtkPolyData> surface = read_triangles(file);
  Vectors points(static_cast<std::size_t>(surface->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) surface->GetPoint(static_cast<vtkIdType>(i), points[i].data());
  std::vector<std::array<int, 3>> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell) {
    surface->GetCellPoints(cell, ids);
    if (ids->GetNumberOfIds() != 3) continue;
    std::array<int, 3> triangle{};
    for (int i = 0; i < 3; ++i) {
      if (ids->GetId(i) < 0 || ids->GetId(i) >= surface->GetNumberOfPoints())
        throw_unread(file, fmt::format("face {} uses a missing point", cell));
      triangle[i] = static_cast<int>(ids->GetId(i));
    }
    triangles.push_back(triangle);
  }
  std::string bytes;
  put(points, bytes);
  put(triangles, bytes);
  return bytes;
}

std::string collection_bytes(const fs::path& pvd) {
  std::istringstream text(read_file(pvd));
  const vtkSmartPointer<vtkXMLDataElement> root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromStream(text));
  vtkXMLDataElement* collection = root == nullptr ? nullptr : root->FindNestedElementWithName("Collection");
  if (collection == nullptr) throw_unread(pvd, "not a collection of frames (.pvd)");
  std::string bytes;
  for (int i = 0; i < collection->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* entry = collection->GetNestedElement(i);
    double time_s = 0;
    const char* file = entry->GetAttribute("file");
    if (file == nullptr || entry->GetScalarAttribute("timestep", time_s) != 1 || !std::isfinite(time_s))
      throw_unread(pvd, fmt::format("frame {} has no file name or no time", i));
    put(std::vector<double>{time_s}, bytes);
    put(std::string(file), bytes);
  }
  return bytes;
}

}  // namespace

Frame read_frame(const fs::path& file) try {
  const std::string bytes = read_in_child(file, [&] { return frame_bytes(file); });
  std::string_view rest = bytes;
  Frame frame;
  frame.positions = take<Vectors>(rest);
  frame.elements = take<std::vector<std::array<NodeId, 8>>>(rest);
  if (frame.elements.empty()) throw_unread(file, "it has no hexahedra");
  const auto time = take<std::vector<double>>(rest);
  if (!time.empty()) frame.time_s = time.front();
  for (std::vector<int>* list :
       {&frame.polygons.ends, &frame.polygons.apical, &frame.polygons.basal, &frame.polygons.elements})
    *list = take<std::vector<int>>(rest);
  const auto vectors = take<std::string>(rest), scalars = take<std::string>(rest);
  for (std::string_view left = vectors; !left.empty();) {
    const auto name = take<std::string>(left);
    frame.node_vectors[name] = take<Vectors>(left);
    require_finite(file, frame.node_vectors[name]);
  }
  for (std::string_view left = scalars; !left.empty();) {
    const auto name = take<std::string>(left);
    frame.element_scalars[name] = take<std::vector<double>>(left);
  }
  require_finite(file, frame.positions);
  return frame;
} catch (const MeshError& error) {
  throw MeshError(fmt::format("{}: {}", file.string(), error.what()));
}

TriangleSurface read_surface(const fs::path& file) {
  // Some of VTK's readers do not say so themselves.
  if (!fs::is_regular_file(file))
    throw_unread(file, fs::exists(file) ? "not a regular file" : "No such file or directory");
  const std::string bytes = read_in_child(file, [&] { return surface_bytes(file); });
  std::string_view rest = bytes;
  TriangleSurface surface;
  surface.points = take<Vectors>(rest);
  surface.triangles = take<std::vector<std::array<int, 3>>>(rest);
  if (surface.triangles.empty()) throw_unread(file, "it has no faces");
  require_finite(file, surface.points);
  return surface;
}

std::vector<std::pair<double, std::string>> read_collection(const fs::path& pvd) {
  const std::string bytes = read_in_child(pvd, [&] { return collection_bytes(pvd); });
  std::vector<std::pair<double, std::string>> entries;
  for (std::string_view rest = bytes; !rest.empty();) {
    const auto time_s = take<std::vector<double>>(rest);
    entries.emplace_back(time_s.front(), take<std::string>(rest));
  }
  return entries;
}

}  // namespace plica
