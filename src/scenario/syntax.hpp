// What the TOML library says of a text that it cannot read, in words that help.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "core/errors.hpp"

namespace plica {

/// Of an error that parsing `text`, which messages call `file`, has thrown: a key that is given twice, a text without
/// quotes, or what the library says.
Diagnostic syntax_diagnostic(const std::string& file, const std::string& text, const toml::parse_error& error);

}  // namespace plica
