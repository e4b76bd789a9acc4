// Escaping of text in XML and HTML.
#pragma once

#include <string>

namespace plica {

/// Escape &, <, > and double quotes.
std::string xml_escaped(const std::string& text);

}  // namespace plica
