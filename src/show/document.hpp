// A page of text, tables and figures, written as Markdown and as HTML from one structure.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace plica {

/// Inline marks in all texts: `code`, **strong**, *emphasis*. Nothing else of Markdown.
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
  std::string name;      // of its files in figures/
  std::string svg;       // the whole file; empty for a picture
  std::string caption;   // in our words
  std::string csv;       // what is drawn; empty for a picture
  std::string png = {};  // of a picture, the whole file
};

struct Document {
  std::string title;
  std::vector<std::variant<Heading, Paragraph, Table, Figure>> blocks;
};

/// DIR/NAME.md, which links to figures/, DIR/NAME.html, which holds everything in itself, and the figures' files.
/// FileError when one cannot be written.
void write_document(const std::filesystem::path& directory, const std::string& name, const Document& document);

}  // namespace plica
