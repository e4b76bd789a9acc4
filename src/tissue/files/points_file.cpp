#include "tissue/files/points_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/files.hpp"
#include "core/numbers.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

PointTable points_in_csv(std::string_view text) {
  constexpr std::array<std::string_view, 3> axes = {"x_um", "y_um", "z_um"};
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // spreadsheets mark UTF-8 so
  std::vector<std::string_view> names;
  std::vector<std::vector<double>> columns;
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(line);
    if (names.empty()) {
      names = fields;
      columns.resize(names.size());
      for (const std::string_view axis : axes)
        if (std::ranges::count(names, axis) != 1)
          throw MeshError(
              fmt::format("line {}: must name the columns, including x_um, y_um and z_um once each; it "
                          "names {}",
                          line_number, fmt::join(names, ", ")));
      continue;
    }
    if (fields.size() != names.size())
      throw MeshError(
          fmt::format("line {}: has {} fields; the first line has {}", line_number, fields.size(), names.size()));
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const std::optional<double> number = number_in(fields[f]);
      if (!number)
        throw MeshError(fmt::format("line {}: \"{}\" of column {} is not a number", line_number, fields[f], names[f]));
      columns[f].push_back(*number);
    }
  }
  if (names.empty()) throw MeshError("is empty; the first line must name the columns, including x_um, y_um and z_um");
  PointTable table;
  table.points.assign(columns.front().size(), Vec3::Zero());
  for (std::size_t f = 0; f < names.size(); ++f) {
    const auto axis = std::ranges::find(axes, names[f]);
    if (axis == axes.end()) {
      table.arrays[std::string(names[f])] = std::move(columns[f]);
      continue;
    }
    for (std::size_t row = 0; row < table.points.size(); ++row)
      table.points[row][axis - axes.begin()] = columns[f][row];
  }
  return table;
}

PointTable read_points_file(const std::filesystem::path& file) {
  try {
    return points_in_csv(read_file(file));
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace plica
