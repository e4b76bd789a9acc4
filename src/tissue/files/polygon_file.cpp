#include "tissue/files/polygon_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/files.hpp"
#include "tissue/files/text_lines.hpp"

namespace plica {
namespace {

using Words = TextLines::Words;

long long whole_in(const TextLines& lines, std::string_view word) {
  return lines.number_in<long long>(word, "a whole number");
}

Vec3 point_in(const TextLines& lines, const Words& words, std::size_t first) {
  if (words.size() < first + 3) lines.complain("a vertex must have three coordinates");
  Vec3 point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::string_view word = words[first + axis];
    if (word.starts_with('+')) word.remove_prefix(1);
    point[static_cast<Eigen::Index>(axis)] = lines.number_in<double>(word, "a number");
  }
  return point;
}

void check_corners(const PolygonFile& file) {
  const std::size_t count = file.surface.vertices.size();
  for (std::size_t face = 0; face < file.surface.polygons.size(); ++face)
    for (const std::size_t vertex : file.surface.polygons[face])
      if (vertex >= count) throw MeshError("face {} uses vertex {}; there are {}", face, vertex, count);
}

}  // namespace

PolygonFile polygons_in_obj(std::string_view text) {
  PolygonFile file;
  TextLines lines(text);
  while (const auto words = lines.words('#')) {
    if (words->front() == "v") file.surface.vertices.push_back(point_in(lines, *words, 1));
    if (words->front() != "f") continue;
    std::vector<std::size_t>& face = file.surface.polygons.emplace_back();
    const auto count = static_cast<long long>(file.surface.vertices.size());
    for (std::size_t w = 1; w < words->size(); ++w) {
      // The vertex, and after a slash its texture and normal. From 1, or from the last one backwards.
      const long long given = whole_in(lines, (*words)[w].substr(0, (*words)[w].find('/')));
      const long long vertex = given < 0 ? count + given : given - 1;
      if (given == 0 || vertex < 0) lines.complain("a face uses vertex {}; the first vertex is 1, the last -1", given);
      face.push_back(static_cast<std::size_t>(vertex));
    }
  }
  check_corners(file);
  return file;
}

PolygonFile polygons_in_off(std::string_view text) {
  PolygonFile file;
  TextLines lines(text);
  auto words = lines.words('#');
  if (!words) throw MeshError("is empty");
  const std::string_view kind = words->front();
  if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF")
    lines.complain("found \"{}\", expected OFF", kind.substr(0, 20));
  words->erase(words->begin());
  if (words->empty()) words = lines.words('#');
  if (!words || words->size() < 2) lines.complain("expected the numbers of vertices and faces");
  const long long vertices = whole_in(lines, words->front()), faces = whole_in(lines, (*words)[1]);
  for (long long v = 0; v < vertices; ++v) {
    words = lines.words('#');
    if (!words) lines.complain("the file ends after {} of {} vertices", v, vertices);
    file.surface.vertices.push_back(point_in(lines, *words, 0));
  }
  for (long long f = 0; f < faces; ++f) {
    words = lines.words('#');
    if (!words) lines.complain("the file ends after {} of {} faces", f, faces);
    const long long corners = whole_in(lines, words->front());
    if (corners < 0 || static_cast<unsigned long long>(corners) >= words->size())
      lines.complain("a face has {1} corners; its line announces {0}", corners, words->size() - 1);
    std::vector<std::size_t>& face = file.surface.polygons.emplace_back();
    for (long long k = 1; k <= corners; ++k) {
      const long long vertex = whole_in(lines, (*words)[static_cast<std::size_t>(k)]);
      if (vertex < 0) lines.complain("a face uses vertex {}; the first vertex is 0", vertex);
      face.push_back(static_cast<std::size_t>(vertex));
    }
  }
  check_corners(file);
  return file;
}

namespace {

PolygonFile read_by_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".obj") return polygons_in_obj(read_file(path));
  if (ending == ".off") return polygons_in_off(read_file(path));
  if (ending == ".ply") return polygons_in_ply(read_file(path));
  if (ending == ".vtp" || ending == ".vtk" || ending == ".vtu") return read_vtk_polygons(path);
  if (ending == ".h5" || ending == ".hdf5" || ending == ".hf5") return read_vertex_model(path);
  if (ending == ".tif" || ending == ".tiff" || ending == ".npy" || ending == ".npz" || ending == ".zarr")
    throw MeshError(
        "is an image; make cells of its labels: of a volume by `plica labels FILE --out cells.vtp`, of a flat image by "
        "plica.polygons_of_labels in Python");
  throw MeshError(
      "\"{}\" is not the extension of a polygon file; readable are .obj, .off, .ply, .vtp, .vtk, .vtu, and .h5, .hdf5 "
      "and .hf5 by tyssue: save the polygons as PLY or OBJ, in MeshLab or ParaView for example",
      ending);
}

}  // namespace

PolygonFile read_polygon_file(const std::filesystem::path& path) {
  PolygonFile file = of_file(path, [&] { return read_by_ending(path); });
  for (auto& [name, values] : file.arrays)
    for (double& value : values)
      if (!std::isfinite(value)) value = std::nan("");
  return file;
}

}  // namespace plica
