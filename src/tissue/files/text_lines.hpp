// Text of a file, line by line and word by word; errors name the line.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "core/numbers.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {

/// Return text without a byte-order mark. MeshError for UTF-16.
inline std::string_view plain_text(std::string_view text) {
  if (is_utf16(text)) throw MeshError("is UTF-16 text; save it as UTF-8");
  return without_byte_order_mark(text);
}

inline constexpr std::string_view blanks = " \t\r\n\f\v";

class TextLines {
 public:
  using Words = std::vector<std::string_view>;

  explicit TextLines(std::string_view text) : text_(plain_text(text)) {}

  /// Return the next line; nothing at the end.
  [[nodiscard]] std::optional<std::string_view> line() {
    if (text_.empty()) return {};
    ++number_;
    const std::string_view line = text_.substr(0, text_.find('\n'));
    text_.remove_prefix(std::min(line.size() + 1, text_.size()));
    return line;
  }

  /// Return the words of the next line that has some before a mark of comments; nothing at the end.
  [[nodiscard]] std::optional<Words> words(char comment = '\n') {
    while (auto text = line()) {
      *text = text->substr(0, text->find(comment));
      Words words;
      for (std::size_t at = text->find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t stop = std::min(text->find_first_of(blanks, at), text->size());
        words.push_back(text->substr(at, stop - at));
        at = text->find_first_not_of(blanks, stop);
      }
      if (!words.empty()) return words;
    }
    return {};
  }

  /// What follows the last line.
  [[nodiscard]] std::string_view rest() const { return text_; }
  [[nodiscard]] int number() const { return number_; }

  template <class... Items>
  [[noreturn]] void complain(fmt::format_string<Items...> what, Items&&... items) const {
    throw MeshError("line {}: {}", number_, fmt::format(what, std::forward<Items>(items)...));
  }

  /// Return a number, perhaps not finite; or complain that the word is not `what`.
  template <class Number>
  [[nodiscard]] Number number_in(std::string_view word, const char* what) const {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) complain("\"{}\" is not {}", word, what);
    return value;
  }

 private:
  std::string_view text_;
  int number_ = 0;
};

}  // namespace plica
