#include "tissue/files/points_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>

#include "core/files.hpp"
#include "core/numbers.hpp"
#include "tissue/files/text_lines.hpp"

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

/// Column of a table. Text is kept until it is known whether the column holds numbers.
struct Column {
  std::string_view name;
  std::vector<double> values;
  bool has_number = false;
  int text_line = 0;  // of the first text, 0: none
  std::string_view text;
};

constexpr std::array<std::string_view, 3> axes = {"x_um", "y_um", "z_um"};

bool is_missing(std::string_view field) {
  std::string lower(field);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 7> words = {"", "nan", "na", "n/a", "null", "none", "inf"};
  return std::ranges::find(words, lower.starts_with('-') ? lower.substr(1) : lower) != words.end();
}

[[noreturn]] void throw_text(const Column& column) {
  throw MeshError("line {}: \"{}\" of column {} is not a number", column.text_line, column.text, column.name);
}

void read_field(std::string_view field, int line, Column& column) {
  std::optional<double> number = number_in(field);
  if (!number && (field == "true" || field == "True" || field == "TRUE")) number = 1;
  if (!number && (field == "false" || field == "False" || field == "FALSE")) number = 0;
  const bool is_axis = std::ranges::find(axes, column.name) != axes.end();
  if (!number && column.text_line == 0 && (is_axis || !is_missing(field))) {
    column.text_line = line;
    column.text = field;
    if (is_axis) throw_text(column);
  }
  column.has_number |= number.has_value();
  column.values.push_back(number.value_or(std::nan("")));
}

std::vector<Column> named_columns(const std::vector<std::string_view>& names, const TextLines& lines, bool of_points) {
  for (const std::string_view axis : axes)
    if (of_points && std::ranges::count(names, axis) != 1)
      lines.complain("must name the columns, including x_um, y_um and z_um once each; it names {}",
                     fmt::join(names, ", "));
  std::vector<Column> columns;
  for (const std::string_view name : names) columns.push_back({.name = name, .values = {}, .text = {}});
  return columns;
}

// Columns of a table whose first line names them; that of points has all axes.
std::vector<Column> columns_in_csv(std::string_view text, bool of_points) {
  std::vector<Column> columns;
  TextLines lines(text);
  while (const auto whole = lines.line()) {
    const std::string_view line = trimmed(*whole);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = fields_of(line);
    if (columns.empty()) {
      columns = named_columns(fields, lines, of_points);
      continue;
    }
    if (fields.size() != columns.size())
      lines.complain("has {} fields; the first line has {}", fields.size(), columns.size());
    for (std::size_t f = 0; f < fields.size(); ++f) read_field(fields[f], lines.number(), columns[f]);
  }
  if (columns.empty())
    throw MeshError("is empty; the first line must name the columns{}",
                    of_points ? ", including x_um, y_um and z_um" : "");
  return columns;
}

}  // namespace

PointTable points_in_csv(std::string_view text) {
  std::vector<Column> columns = columns_in_csv(text, true);
  PointTable table;
  table.points.assign(columns.front().values.size(), Vec3::Zero());
  for (Column& column : columns) {
    if (const auto axis = std::ranges::find(axes, column.name); axis != axes.end()) {
      for (std::size_t row = 0; row < table.points.size(); ++row)
        table.points[row][axis - axes.begin()] = column.values[row];
    } else if (column.text_line == 0) {
      table.arrays[std::string(column.name)] = std::move(column.values);
    } else if (column.has_number) {
      throw_text(column);
    } else {
      table.remarks.push_back(fmt::format("column {} contains text and is not an array", column.name));
    }
  }
  return table;
}

PointTable read_points_file(const std::filesystem::path& file) {
  return of_file(file, [text = read_file(file)] { return points_in_csv(text); });
}

std::map<std::string, std::vector<double>> read_cell_table(const std::filesystem::path& file) {
  return of_file(file, [text = read_file(file)] {
    std::map<std::string, std::vector<double>> arrays;
    std::vector<Column> columns = columns_in_csv(text, false);
    for (Column& column : columns) {
      if (column.text_line > 0) throw_text(column);
      if (!arrays.emplace(column.name, std::move(column.values)).second)
        throw MeshError("line 1: names column {} twice", column.name);
    }
    return arrays;
  });
}

}  // namespace plica
