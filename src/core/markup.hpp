// Text inside XML and HTML.
#pragma once

#include <string>

namespace plica {

/// Text with &, <, > and quotes as XML and HTML want them.
std::string xml_escaped(const std::string& text);

}  // namespace plica
