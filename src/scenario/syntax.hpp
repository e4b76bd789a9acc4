// Messages for TOML syntax errors.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "core/errors.hpp"

namespace plica {

/// Converts a parse error of `text` (named `file` in messages) to a message: a key set twice, text without quotes, or
/// the library's own description.
Diagnostic syntax_diagnostic(const std::string& file, const std::string& text, const toml::parse_error& error);

}  // namespace plica
