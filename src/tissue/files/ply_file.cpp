// Stanford PLY: a header that lists elements and their properties, then their values as text or bytes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "tissue/files/plain_text.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_of(std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names = {{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
  for (std::size_t t = 0; t < names.size(); ++t)
    if (std::ranges::find(names[t], word) != names[t].end()) return static_cast<Type>(t);
  return {};
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> counted_by;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Format { ascii, little, big };

// Line by line, so that what follows the header can be bytes.
class Header {
 public:
  explicit Header(std::string_view& bytes) : bytes_(bytes) {
    if (next().front() != "ply") complain("expected \"ply\"");
    for (auto words = next(); words.front() != "end_header"; words = next()) {
      if (words.front() == "format") read_format(words);
      if (words.front() == "element") read_element(words);
      if (words.front() == "property") read_property(words);
    }
    if (!format) complain("the header has no format line");
  }

  std::optional<Format> format;
  std::vector<Element> elements;

 private:
  [[noreturn]] void complain(const std::string& what) const {
    throw MeshError(fmt::format("line {}: {}", line_, what));
  }

  std::vector<std::string_view> next() {
    ++line_;
    const std::size_t end = bytes_.find('\n');
    if (end == std::string_view::npos) complain("the file ends within the header");
    std::string_view line = bytes_.substr(0, end);
    bytes_.remove_prefix(end + 1);
    std::vector<std::string_view> words;
    for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
      const std::size_t stop = std::min(line.find_first_of(" \t\r", at), line.size());
      words.push_back(line.substr(at, stop - at));
      at = line.find_first_not_of(" \t\r", stop);
    }
    if (words.empty()) words.emplace_back("comment");
    return words;
  }

  void read_format(const std::vector<std::string_view>& words) {
    const std::string_view word = words.size() > 1 ? words[1] : "";
    if (word == "ascii") format = Format::ascii;
    if (word == "binary_little_endian") format = Format::little;
    if (word == "binary_big_endian") format = Format::big;
    if (!format)
      complain(fmt::format("\"{}\" is not a format; formats: ascii, binary_little_endian, binary_big_endian", word));
  }

  void read_element(const std::vector<std::string_view>& words) {
    Element element;
    if (words.size() < 3) complain("an element must have a name and a count");
    element.name = words[1];
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
      complain(fmt::format("\"{}\" is not a number of elements", words[2]));
    if (std::ranges::find(elements, element.name, &Element::name) != elements.end())
      complain(fmt::format("the header has two elements \"{}\"; rename one", element.name));
    elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (elements.empty()) complain("a property precedes the first element");
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) complain("a property must have a type and a name");
    const std::optional<Type> type = type_of(words[words.size() - 2]), count = is_list ? type_of(words[2]) : Type::int8;
    if (!type || !count) complain(fmt::format("\"{}\": unknown type", fmt::join(words, " ")));
    Element& element = elements.back();
    if (std::ranges::find(element.properties, words.back(), &Property::name) != element.properties.end())
      complain(fmt::format("element \"{}\" has two properties \"{}\"; rename one", element.name, words.back()));
    element.properties.push_back({std::string(words.back()), *type, is_list ? count : std::optional<Type>()});
  }

  std::string_view& bytes_;
  int line_ = 0;
};

/// The numbers after the header, one after the other.
class Numbers {
 public:
  Numbers(std::string_view bytes, Format format) : bytes_(bytes), format_(format) {}

  double next(Type type) {
    if (format_ == Format::ascii) return next_word();
    switch (type) {
      case Type::int8:
        return next_of<std::int8_t>();
      case Type::uint8:
        return next_of<std::uint8_t>();
      case Type::int16:
        return next_of<std::int16_t>();
      case Type::uint16:
        return next_of<std::uint16_t>();
      case Type::int32:
        return next_of<std::int32_t>();
      case Type::uint32:
        return next_of<std::uint32_t>();
      case Type::float32:
        return next_of<float>();
      case Type::float64:
        break;
    }
    return next_of<double>();
  }

  /// Read the length of a list, bounded by the size of the file.
  std::size_t next_count(Type type) {
    const double count = next(type);
    if (!(count >= 0) || count > static_cast<double>(bytes_.size()) || count != std::floor(count))
      throw MeshError(fmt::format("a list has the invalid length {}", count));
    return static_cast<std::size_t>(count);
  }

 private:
  template <class Number>
  double next_of() {
    if (bytes_.size() < sizeof(Number)) throw MeshError("the file ends early");
    std::array<char, sizeof(Number)> raw;
    std::copy_n(bytes_.begin(), raw.size(), raw.begin());
    bytes_.remove_prefix(raw.size());
    if ((format_ == Format::big) != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

  double next_word() {
    constexpr std::string_view blanks = " \t\r\n\f\v";
    const std::size_t start = bytes_.find_first_not_of(blanks);
    if (start == std::string_view::npos) throw MeshError("the file ends early");
    const std::size_t end = std::min(bytes_.find_first_of(blanks, start), bytes_.size());
    const std::string_view word = bytes_.substr(start, end - start);
    bytes_.remove_prefix(end);
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
      throw MeshError(fmt::format("\"{}\" is not a number", word.substr(0, 40)));
    return value;
  }

  std::string_view bytes_;
  Format format_;
};

bool is_corners(const Property& property) {
  return property.counted_by && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void read_face(const Element& element, std::size_t face, Numbers& numbers, PolygonFile& file) {
  for (const Property& property : element.properties) {
    if (!property.counted_by) {
      const double value = numbers.next(property.type);
      file.arrays[property.name].push_back(value);
      continue;
    }
    const std::size_t count = numbers.next_count(*property.counted_by);
    for (std::size_t k = 0; k < count; ++k) {
      const double vertex = numbers.next(property.type);
      if (!is_corners(property)) continue;
      if (!(vertex >= 0) || !(vertex < static_cast<double>(file.surface.vertices.size())) ||
          vertex != std::floor(vertex))
        throw MeshError(
            fmt::format("face {} uses vertex {}; {} precede it", face, vertex, file.surface.vertices.size()));
      file.surface.polygons[face].push_back(static_cast<std::size_t>(vertex));
    }
  }
}

void read_vertex(const Element& element, Numbers& numbers, PolygonFile& file) {
  Vec3 point = Vec3::Zero();
  for (const Property& property : element.properties) {
    std::size_t count = property.counted_by ? numbers.next_count(*property.counted_by) : 1;
    for (; count > 0; --count) {
      const double value = numbers.next(property.type);
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
        point[property.name[0] - 'x'] = value;
    }
  }
  file.surface.vertices.push_back(point);
}

void check_properties(const Element& element) {
  std::size_t found = 0;
  for (const Property& property : element.properties)
    found += element.name == "face" ? is_corners(property)
                                    : property.name == "x" || property.name == "y" || property.name == "z";
  if (element.name == "vertex" && found != 3) throw MeshError("vertices must have x, y and z");
  if (element.name == "face" && found != 1) throw MeshError("faces must have one list vertex_indices or vertex_index");
}

}  // namespace

PolygonFile polygons_in_ply(std::string_view bytes) {
  bytes = plain_text(bytes);
  const Header header(bytes);
  Numbers numbers(bytes, *header.format);
  PolygonFile file;
  for (const Element& element : header.elements) {
    check_properties(element);
    // A number has at least a byte; elements without numbers are none.
    if (element.count > bytes.size())
      throw MeshError(fmt::format("{} elements \"{}\" exceed the file", element.count, element.name));
    if (element.name == "face") file.surface.polygons.resize(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        read_vertex(element, numbers, file);
      } else if (element.name == "face") {
        read_face(element, i, numbers, file);
      } else {
        for (const Property& property : element.properties)
          for (std::size_t n = property.counted_by ? numbers.next_count(*property.counted_by) : 1; n > 0; --n)
            numbers.next(property.type);
      }
    }
  }
  return file;
}

}  // namespace plica
