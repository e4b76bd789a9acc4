// Expects a MeshError whose text says something.
#pragma once

#include "support/testing.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {

template <class Call>
void expect_mesh_error(const Call& call, const std::string& text) {
  EXPECT_SAYS(error_of<MeshError>(call), text);
}

}  // namespace plica
