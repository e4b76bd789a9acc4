// Expects a MeshError whose text says something.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {

template <class Call>
void expect_mesh_error(Call call, const std::string& text) {
  try {
    call();
    ADD_FAILURE() << "no error; expected one with: " << text;
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

}  // namespace plica
