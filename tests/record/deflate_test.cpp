#include "record/deflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

namespace plica {
namespace {

std::string inflated(std::string_view bytes, std::size_t size) {
  std::string result(size, '\0');
  uLongf length = size;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(result.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
            Z_OK);
  result.resize(length);
  return result;
}

TEST(Deflater, WhatItCompressesZlibGivesBack) {
  int cases = 0;
  for (const Deflater::Effort effort : {Deflater::Effort::fast, Deflater::Effort::small}) {
    Deflater deflater(effort);
    for (const int size : {0, 1, 10000, 300000}) {
      std::string bytes, compressed = "before";
      for (int i = 0; i < size; ++i) bytes += static_cast<char>(i * (i % 17) % 251);
      const std::size_t count = deflater.append(bytes, compressed);
      ASSERT_EQ(compressed.size(), 6 + count);
      EXPECT_EQ(compressed.substr(0, 6), "before");
      EXPECT_EQ(inflated(std::string_view(compressed).substr(6), bytes.size()), bytes);
      EXPECT_LE(count, bytes.size() + 20);
      if (size > 1000) {
        EXPECT_LT(2 * count, bytes.size());
      }
      ++cases;
    }
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
