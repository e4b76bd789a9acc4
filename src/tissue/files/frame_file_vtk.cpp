#include <fmt/format.h>
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

Frame frame_in(const fs::path& file) {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(file);
  const GridHexahedra found = hexahedra_of(*grid);
  Frame frame{found.points, found.hexahedra, {}, {}, {}};
  vtkDataArray* time = grid->GetFieldData()->GetArray("TimeValue");
  if (time != nullptr && time->GetNumberOfTuples() == 1) frame.time_s = time->GetTuple1(0);
  for (const auto& [name, values] : {std::pair("polygon_ends", &frame.polygons.ends),
                                     {"polygon_apical", &frame.polygons.apical},
                                     {"polygon_basal", &frame.polygons.basal},
                                     {"polygon_elements", &frame.polygons.elements}})
    if (vtkDataArray* array = grid->GetFieldData()->GetArray(name))
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
        values->push_back(static_cast<int>(array->GetTuple1(i)));
  for_arrays(*grid->GetPointData(), 3, [&](const std::string& name, vtkDataArray& array) {
    if (array.GetNumberOfTuples() != grid->GetNumberOfPoints()) return;
    Vectors& values = frame.node_vectors[name];
    values.resize(frame.positions.size());
    for (std::size_t n = 0; n < values.size(); ++n) array.GetTuple(static_cast<vtkIdType>(n), values[n].data());
  });
  for_arrays(*grid->GetCellData(), 1, [&](const std::string& name, vtkDataArray& array) {
    if (array.GetNumberOfTuples() != grid->GetNumberOfCells()) return;
    std::vector<double>& values = frame.element_scalars[name];
    for (const vtkIdType cell : found.cells) values.push_back(array.GetTuple1(cell));
  });
  return frame;
}

TriangleSurface surface_in(const fs::path& file) {
  const vtkSmartPointer<vtkPolyData> data = read_triangles(file);
  TriangleSurface surface{points_of(*data), {}};
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell) {
    data->GetCellPoints(cell, ids);
    if (ids->GetNumberOfIds() != 3) continue;
    std::array<int, 3>& triangle = surface.triangles.emplace_back();
    for (int i = 0; i < 3; ++i) {
      if (ids->GetId(i) < 0 || ids->GetId(i) >= data->GetNumberOfPoints())
        throw_unread(file, fmt::format("face {} uses a missing point", cell));
      triangle[i] = static_cast<int>(ids->GetId(i));
    }
  }
  return surface;
}

struct Collection {
  std::vector<double> times_s;
  std::vector<std::string> files;

  static auto parts(auto& collection) { return std::tie(collection.times_s, collection.files); }
};

Collection collection_in(const fs::path& pvd) {
  std::istringstream text(read_file(pvd));
  const vtkSmartPointer<vtkXMLDataElement> root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromStream(text));
  vtkXMLDataElement* entries = root == nullptr ? nullptr : root->FindNestedElementWithName("Collection");
  if (entries == nullptr) throw_unread(pvd, "not a collection of frames (.pvd)");
  Collection collection;
  for (int i = 0; i < entries->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* entry = entries->GetNestedElement(i);
    double& time_s = collection.times_s.emplace_back();
    const char* file = entry->GetAttribute("file");
    if (file == nullptr || entry->GetScalarAttribute("timestep", time_s) != 1 || !std::isfinite(time_s))
      throw_unread(pvd, fmt::format("frame {} has no file name or no time", i));
    collection.files.emplace_back(file);
  }
  return collection;
}

}  // namespace

Frame read_frame(const fs::path& file) {
  Frame frame = of_file(file, [&] { return read_in_child(file, [&] { return frame_in(file); }); });
  if (frame.elements.empty()) throw_unread(file, "it has no hexahedra");
  for (const auto& [name, vectors] : frame.node_vectors) require_finite(file, vectors);
  require_finite(file, frame.positions);
  return frame;
}

TriangleSurface read_surface(const fs::path& file) {
  // Some of VTK's readers do not say so themselves.
  if (!fs::is_regular_file(file))
    throw_unread(file, fs::exists(file) ? "not a regular file" : "No such file or directory");
  TriangleSurface surface = read_in_child(file, [&] { return surface_in(file); });
  if (surface.triangles.empty()) throw_unread(file, "it has no faces");
  require_finite(file, surface.points);
  return surface;
}

std::vector<std::pair<double, std::string>> read_collection(const fs::path& pvd) {
  const Collection collection = read_in_child(pvd, [&] { return collection_in(pvd); });
  std::vector<std::pair<double, std::string>> entries;
  for (std::size_t i = 0; i < collection.files.size(); ++i)
    entries.emplace_back(collection.times_s[i], collection.files[i]);
  return entries;
}

}  // namespace plica
