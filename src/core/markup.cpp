#include "core/markup.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace plica {

std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    if (letter == '&')
      escaped += "&amp;";
    else if (letter == '<')
      escaped += "&lt;";
    else if (letter == '>')
      escaped += "&gt;";
    else if (letter == '"')
      escaped += "&quot;";
    else
      escaped += letter;
  }
  return escaped;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  char* at = text.data();
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k <= count; ++k) at[k] = digits[group >> (18 - 6 * k) & 63];
    at += 4;
  }
  return text;
}

Deflater::Deflater(Effort effort) : compressor_(libdeflate_alloc_compressor(effort == Effort::fast ? 1 : 6)) {
  if (compressor_ == nullptr) throw std::bad_alloc();
}

Deflater::~Deflater() { libdeflate_free_compressor(compressor_); }

std::size_t Deflater::append(std::string_view bytes, std::string& to) {
  const std::size_t before = to.size();
  to.resize(before + libdeflate_zlib_compress_bound(compressor_, bytes.size()));
  const std::size_t count = libdeflate_zlib_compress(compressor_, bytes.data(), bytes.size(), to.data() + before,
                                                     to.size() - before);  // never 0: the buffer is large enough
  to.resize(before + count);
  return count;
}

}  // namespace plica
