// A checkpoint member by member. Every structure is taken apart whole: one that has got a member more does not compile
// here until the member has a name below.
#pragma once

#include "record/checkpoint.hpp"
#include "support/testing.hpp"

namespace plica::support {

/// The numbers that each member holds, by its name; of text, its letters.
std::map<std::string, std::vector<double>> fields_of(const Checkpoint& checkpoint);

/// The checkpoint with a value of its own in every member that usually has none. It fits no embryo.
Checkpoint marked(Checkpoint checkpoint);

}  // namespace plica::support
