// What every test includes: GoogleTest, the parts of the standard library that tests use, what messages say.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Whether a part is in a text; both are shown where it is not.
#define EXPECT_SAYS(text, part) EXPECT_PRED_FORMAT2(testing::IsSubstring, std::string(part), text)
#define EXPECT_SAYS_NOT(text, part) EXPECT_PRED_FORMAT2(testing::IsNotSubstring, std::string(part), text)

namespace plica::support {

/// What a call says as it throws an error of this kind; nothing where it succeeds.
template <class Expected = std::exception, class Call>
std::string error_of(const Call& call) {
  try {
    (void)call();
    return "";
  } catch (const Expected& error) {
    return error.what();
  }
}

}  // namespace plica::support

// In every test.
using namespace plica;
using namespace plica::support;
