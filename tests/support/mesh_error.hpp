// Expects a MeshError whose text says something.
#pragma once

#include "support/testing.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {

template <class Call>
void expect_mesh_error(Call call, const std::string& text) {
  try {
    call();
    ADD_FAILURE() << "no error; expected one with: " << text;
  } catch (const MeshError& error) {
    EXPECT_SAYS(std::string(error.what()), text) << error.what();
  }
}

}  // namespace plica
