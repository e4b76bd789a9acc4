// Byte-order marks, with which editors and spreadsheets begin Unicode text.
#pragma once

#include <string_view>

namespace plica {

/// Return UTF-8 text without its mark, if it has one.
inline std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

/// Whether text begins with the mark of UTF-16, which no reader understands.
inline bool is_utf16(std::string_view text) { return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"); }

}  // namespace plica
