// Fields of CSV texts that may hold anything: in quotes where they need it (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// A field as it stands in a row.
std::string csv_field(std::string_view text);

/// All rows of a text, empty lines left out.
std::vector<std::vector<std::string>> csv_fields(std::string_view text);

}  // namespace plica
