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

#include "tissue/files/polygon_file.hpp"
#include "tissue/files/text_lines.hpp"

namespace plica {
namespace {

enum class Format { ascii, little, big };

/// The numbers after the header, one after the other.
class Numbers {
 public:
  using Read = double (Numbers::*)();  // of a type

  Numbers(std::string_view bytes, Format format) : bytes_(bytes), format_(format) {}

  double next(Read read) { return format_ == Format::ascii ? next_word() : (this->*read)(); }

  /// Read the length of a list, bounded by the size of the file.
  std::size_t next_count(Read read) {
    const double count = next(read);
    if (!(count >= 0) || count > static_cast<double>(bytes_.size()) || count != std::floor(count))
      throw MeshError("a list has the invalid length {}", count);
    return static_cast<std::size_t>(count);
  }

  template <class Number>
  double next_of() {
    if (bytes_.size() < sizeof(Number)) throw MeshError("the file ends early");
    std::array<char, sizeof(Number)> raw;
    std::copy_n(bytes_.begin(), raw.size(), raw.begin());
    bytes_.remove_prefix(raw.size());
    if ((format_ == Format::big) != (std::endian::native == std::endian::big)) std::ranges::reverse(raw);
    return static_cast<double>(std::bit_cast<Number>(raw));
  }

 private:
  double next_word() {
    const std::size_t start = bytes_.find_first_not_of(blanks);
    if (start == std::string_view::npos) throw MeshError("the file ends early");
    const std::size_t end = std::min(bytes_.find_first_of(blanks, start), bytes_.size());
    const std::string_view word = bytes_.substr(start, end - start);
    bytes_.remove_prefix(end);
    double value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
      throw MeshError("\"{}\" is not a number", word.substr(0, 40));
    return value;
  }

  std::string_view bytes_;
  Format format_;
};

/// Type by its two names; null if unknown.
Numbers::Read type_of(std::string_view word) {
  struct Type {
    std::string_view name, other_name;
    Numbers::Read read;
  };
  for (const auto& [name, other_name, read] : {Type{"char", "int8", &Numbers::next_of<std::int8_t>},
                                               {"uchar", "uint8", &Numbers::next_of<std::uint8_t>},
                                               {"short", "int16", &Numbers::next_of<std::int16_t>},
                                               {"ushort", "uint16", &Numbers::next_of<std::uint16_t>},
                                               {"int", "int32", &Numbers::next_of<std::int32_t>},
                                               {"uint", "uint32", &Numbers::next_of<std::uint32_t>},
                                               {"float", "float32", &Numbers::next_of<float>},
                                               {"double", "float64", &Numbers::next_of<double>}})
    if (word == name || word == other_name) return read;
  return nullptr;
}

struct Property {
  std::string name;
  Numbers::Read type;
  Numbers::Read counted_by;  // of a list; else null
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

// Line by line, so that what follows the header can be bytes.
class Header {
 public:
  explicit Header(std::string_view bytes) : lines_(bytes) {
    if (next().front() != "ply") lines_.complain("expected \"ply\"");
    for (auto words = next(); words.front() != "end_header"; words = next()) {
      if (words.front() == "format") read_format(words);
      if (words.front() == "element") read_element(words);
      if (words.front() == "property") read_property(words);
    }
    if (!format) lines_.complain("the header has no format line");
  }

  std::optional<Format> format;
  std::vector<Element> elements;

  [[nodiscard]] std::string_view bytes_after() const { return lines_.rest(); }

 private:
  using Words = TextLines::Words;

  Words next() {
    const auto words = lines_.words();
    if (!words) lines_.complain("the file ends within the header");
    return *words;
  }

  void read_format(const Words& words) {
    const std::string_view word = words.size() > 1 ? words[1] : "";
    if (word == "ascii") format = Format::ascii;
    if (word == "binary_little_endian") format = Format::little;
    if (word == "binary_big_endian") format = Format::big;
    if (!format)
      lines_.complain("\"{}\" is not a format; formats: ascii, binary_little_endian, binary_big_endian", word);
  }

  void read_element(const Words& words) {
    if (words.size() < 3) lines_.complain("an element must have a name and a count");
    const auto count = lines_.number_in<std::size_t>(words[2], "a number of elements");
    if (std::ranges::find(elements, words[1], &Element::name) != elements.end())
      lines_.complain("the header has two elements \"{}\"; rename one", words[1]);
    elements.push_back({std::string(words[1]), count, {}});
  }

  void read_property(const Words& words) {
    if (elements.empty()) lines_.complain("a property precedes the first element");
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3) lines_.complain("a property must have a type and a name");
    const Numbers::Read type = type_of(words[words.size() - 2]), counted_by = is_list ? type_of(words[2]) : nullptr;
    if (type == nullptr || (is_list && counted_by == nullptr))
      lines_.complain("\"{}\": unknown type", fmt::join(words, " "));
    Element& element = elements.back();
    if (std::ranges::find(element.properties, words.back(), &Property::name) != element.properties.end())
      lines_.complain("element \"{}\" has two properties \"{}\"; rename one", element.name, words.back());
    element.properties.push_back({std::string(words.back()), type, counted_by});
  }

  TextLines lines_;
};

/// Number of values of a property: the length of a list, or 1.
std::size_t next_length(const Property& property, Numbers& numbers) {
  return property.counted_by == nullptr ? 1 : numbers.next_count(property.counted_by);
}

bool is_corners(const Property& property) {
  return property.counted_by != nullptr && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void read_face(const Element& element, std::size_t face, Numbers& numbers, PolygonFile& file) {
  for (const Property& property : element.properties) {
    for (std::size_t left = next_length(property, numbers); left > 0; --left) {
      const double vertex = numbers.next(property.type);
      if (property.counted_by == nullptr) file.arrays[property.name].push_back(vertex);
      if (!is_corners(property)) continue;
      if (!(vertex >= 0) || !(vertex < static_cast<double>(file.surface.vertices.size())) ||
          vertex != std::floor(vertex))
        throw MeshError("face {} uses vertex {}; {} precede it", face, vertex, file.surface.vertices.size());
      file.surface.polygons[face].push_back(static_cast<std::size_t>(vertex));
    }
  }
}

void read_vertex(const Element& element, Numbers& numbers, PolygonFile& file) {
  Vec3 point = Vec3::Zero();
  for (const Property& property : element.properties) {
    for (std::size_t left = next_length(property, numbers); left > 0; --left) {
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
  const Header header(bytes);
  bytes = header.bytes_after();
  Numbers numbers(bytes, *header.format);
  PolygonFile file;
  for (const Element& element : header.elements) {
    check_properties(element);
    // A number has at least a byte; elements without numbers are none.
    if (element.count > bytes.size())
      throw MeshError("{} elements \"{}\" exceed the file", element.count, element.name);
    if (element.name == "face") file.surface.polygons.resize(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        read_vertex(element, numbers, file);
      } else if (element.name == "face") {
        read_face(element, i, numbers, file);
      } else {
        for (const Property& property : element.properties)
          for (std::size_t left = next_length(property, numbers); left > 0; --left) numbers.next(property.type);
      }
    }
  }
  return file;
}

}  // namespace plica
