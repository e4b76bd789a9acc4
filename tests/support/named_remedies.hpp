// Remedies that a message names, as overrides, so that tests can try them.
#pragma once

#include "support/testing.hpp"

namespace plica::support {

inline std::vector<std::string> parts_of(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + separator.size()) {
    end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
  }
  return parts;
}

/// One list of "key = value" for each alternative of "...; set KEY = VALUE and KEY = VALUE (EFFECT), or KEY = ...".
inline std::vector<std::vector<std::string>> named_remedies(const std::string& message) {
  std::vector<std::vector<std::string>> remedies;
  const std::string mark = "; set ";
  const std::size_t begin = message.rfind(mark);
  if (begin == std::string::npos) return remedies;
  for (const std::string& alternative : parts_of(std::string_view(message).substr(begin + mark.size()), ", or "))
    remedies.push_back(parts_of(alternative.substr(0, alternative.rfind(" (")), " and "));
  return remedies;
}

}  // namespace plica::support
