#include "tissue/files/polygon_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/files.hpp"
#include "tissue/files/plain_text.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

/// Lines that hold something, without comments, and the words of each.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(plain_text(text)) {}

  /// The next line's words; nothing at the end.
  [[nodiscard]] std::optional<std::vector<std::string_view>> next() {
    while (!text_.empty()) {
      ++number_;
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      line = line.substr(0, line.find('#'));
      std::vector<std::string_view> words;
      constexpr std::string_view blanks = " \t\r\f\v";
      for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t stop = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, stop - at));
        at = line.find_first_not_of(blanks, stop);
      }
      if (!words.empty()) return words;
    }
    return {};
  }

  [[noreturn]] void complain(const std::string& what) const {
    throw MeshError(fmt::format("line {}: {}", number_, what));
  }

  /// A number, not a finite one perhaps.
  [[nodiscard]] double number(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) complain(fmt::format("\"{}\" is not a number", word));
    return value;
  }

  [[nodiscard]] long long whole(std::string_view word) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      complain(fmt::format("\"{}\" is not a whole number", word));
    return value;
  }

  [[nodiscard]] Vec3 point(const std::vector<std::string_view>& words, std::size_t first) const {
    if (words.size() < first + 3) complain("a vertex must have three coordinates");
    return {number(words[first]), number(words[first + 1]), number(words[first + 2])};
  }

 private:
  std::string_view text_;
  int number_ = 0;
};

void check_corners(const PolygonFile& file) {
  const std::size_t count = file.surface.vertices.size();
  for (std::size_t face = 0; face < file.surface.polygons.size(); ++face)
    for (const std::size_t vertex : file.surface.polygons[face])
      if (vertex >= count) throw MeshError(fmt::format("face {} uses vertex {}; there are {}", face, vertex, count));
}

}  // namespace

PolygonFile polygons_in_obj(std::string_view text) {
  PolygonFile file;
  Lines lines(text);
  while (const auto words = lines.next()) {
    if (words->front() == "v") file.surface.vertices.push_back(lines.point(*words, 1));
    if (words->front() != "f") continue;
    std::vector<std::size_t>& face = file.surface.polygons.emplace_back();
    const auto count = static_cast<long long>(file.surface.vertices.size());
    for (std::size_t w = 1; w < words->size(); ++w) {
      // The vertex, and after a slash its texture and normal. From 1, or from the last one backwards.
      const long long given = lines.whole((*words)[w].substr(0, (*words)[w].find('/')));
      const long long vertex = given < 0 ? count + given : given - 1;
      if (given == 0 || vertex < 0)
        lines.complain(fmt::format("a face uses vertex {}; the first vertex is 1, the last -1", given));
      face.push_back(static_cast<std::size_t>(vertex));
    }
  }
  check_corners(file);
  return file;
}

PolygonFile polygons_in_off(std::string_view text) {
  PolygonFile file;
  Lines lines(text);
  auto words = lines.next();
  if (!words) throw MeshError("is empty");
  const std::string_view kind = words->front();
  if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF")
    lines.complain(fmt::format("found \"{}\", expected OFF", kind.substr(0, 20)));
  words->erase(words->begin());
  if (words->empty()) words = lines.next();
  if (!words || words->size() < 2) lines.complain("expected the numbers of vertices and faces");
  const long long vertices = lines.whole(words->front()), faces = lines.whole((*words)[1]);
  for (long long v = 0; v < vertices; ++v) {
    words = lines.next();
    if (!words) lines.complain(fmt::format("the file ends after {} of {} vertices", v, vertices));
    file.surface.vertices.push_back(lines.point(*words, 0));
  }
  for (long long f = 0; f < faces; ++f) {
    words = lines.next();
    if (!words) lines.complain(fmt::format("the file ends after {} of {} faces", f, faces));
    const long long corners = lines.whole(words->front());
    if (corners < 0 || static_cast<unsigned long long>(corners) >= words->size())
      lines.complain(fmt::format("a face has {1} corners; its line announces {0}", corners, words->size() - 1));
    std::vector<std::size_t>& face = file.surface.polygons.emplace_back();
    for (long long k = 1; k <= corners; ++k) {
      const long long vertex = lines.whole((*words)[static_cast<std::size_t>(k)]);
      if (vertex < 0) lines.complain(fmt::format("a face uses vertex {}; the first vertex is 0", vertex));
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
  throw MeshError(
      fmt::format("\"{}\" is not the extension of a polygon file; readable are .obj, .off, .ply, .vtp, .vtk, .vtu, and "
                  ".h5, .hdf5 and .hf5 by tyssue: save the polygons as PLY or OBJ, in MeshLab or ParaView for example",
                  ending));
}

}  // namespace

PolygonFile read_polygon_file(const std::filesystem::path& path) {
  try {
    PolygonFile file = read_by_ending(path);
    for (auto& [name, values] : file.arrays)
      for (double& value : values)
        if (!std::isfinite(value)) value = std::nan("");
    return file;
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace plica
