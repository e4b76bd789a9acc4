#include "core/base64.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

// The vectors of RFC 4648, section 10, and bytes above 127.
TEST(Base64, IsAsInTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\x89PNG\xff"), "iVBOR/8=");
}

}  // namespace
}  // namespace plica
