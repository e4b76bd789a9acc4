// Text of a file as the readers take it.
#pragma once

#include <string_view>

#include "core/numbers.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {

/// Return text without a byte-order mark. MeshError for UTF-16.
inline std::string_view plain_text(std::string_view text) {
  if (is_utf16(text)) throw MeshError("is UTF-16 text; save it as UTF-8");
  return without_byte_order_mark(text);
}

}  // namespace plica
