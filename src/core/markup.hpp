// Text and data in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace plica {

/// Escape &, <, > and double quotes.
std::string xml_escaped(const std::string& text);

/// Encode bytes in base64 (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace plica
