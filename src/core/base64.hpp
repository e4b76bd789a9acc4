// Base64 encoding.
#pragma once

#include <string>
#include <string_view>

namespace plica {

/// Encode bytes by RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace plica
