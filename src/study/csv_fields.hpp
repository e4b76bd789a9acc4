// Fields of CSV texts, quoted where necessary (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Quote a field if necessary.
std::string csv_field(std::string_view text);

/// Parse all rows of a text; empty lines are skipped.
std::vector<std::vector<std::string>> csv_fields(std::string_view text);

}  // namespace plica
