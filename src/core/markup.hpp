// Text and data in XML and HTML: escaped, compressed and encoded.
#pragma once

#include <string>
#include <string_view>

struct libdeflate_compressor;

namespace plica {

/// Escape &, <, > and double quotes.
std::string xml_escaped(const std::string& text);

/// Encode bytes in base64 (RFC 4648).
std::string base64(std::string_view bytes);

/// Compressor to zlib format (RFC 1950), readable by browsers and VTK.
class Deflater {
 public:
  enum class Effort { fast, small };

  /// Throws std::bad_alloc without memory.
  explicit Deflater(Effort effort);
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater();

  /// Append compressed bytes to `to`; returns their number.
  std::size_t append(std::string_view bytes, std::string& to);

 private:
  libdeflate_compressor* compressor_;
};

}  // namespace plica
