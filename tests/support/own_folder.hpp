// A folder of a test's own, removed at its end.
#pragma once

#include <unistd.h>

#include "support/testing.hpp"

namespace plica::support {

class OwnFolder : public testing::Test {
 protected:
  OwnFolder() { std::filesystem::create_directories(folder); }
  ~OwnFolder() override { std::filesystem::remove_all(folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("plica_" + std::to_string(::getpid()));
};

}  // namespace plica::support
