#include "record/deflate.hpp"

#include <libdeflate.h>

#include <new>

namespace plica {

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
