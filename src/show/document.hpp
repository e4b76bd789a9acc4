// Page of text, tables and figures, written as Markdown and HTML from one structure.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace plica {

/// Heading. Inline marks in all texts: `code`, **strong**, *emphasis*; no other Markdown.
struct Heading {
  int level = 2;
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
struct Figure {
  std::string name;      // name of its files in figures/
  std::string svg;       // complete file; empty for a picture
  std::string caption;   // Markdown text
  std::string csv;       // data of the plot; empty for a picture
  std::string png = {};  // complete file, for a picture
};

struct Document {
  std::string title;
  std::vector<std::variant<Heading, Paragraph, Table, Figure>> blocks;
};

/// Write DIR/NAME.md (links to figures/), DIR/NAME.html (self-contained) and the files of figures. Throws FileError.
void write_document(const std::filesystem::path& directory, const std::string& name, const Document& document);

}  // namespace plica
