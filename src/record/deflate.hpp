// Compression in zlib's format (RFC 1950), which browsers and readers of VTK's files inflate.
#pragma once

#include <string>
#include <string_view>

struct libdeflate_compressor;

namespace plica {

class Deflater {
 public:
  enum class Effort { fast, small };

  /// std::bad_alloc when memory is short.
  explicit Deflater(Effort effort);
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater();

  /// Adds the bytes to `to`, compressed; returns how many they became.
  std::size_t append(std::string_view bytes, std::string& to);

 private:
  libdeflate_compressor* compressor_;
};

}  // namespace plica
