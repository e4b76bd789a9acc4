#include "solver/linear/iterate.hpp"

namespace plica {

std::vector<int> pattern_revisions(const Model& model, const Step& step) {
  std::vector<int> revisions;
  for_laws(model, step,
           [&](const Law& law, const Step& own) { revisions.push_back(law.pattern_revision(own.internal)); });
  return revisions;
}

}  // namespace plica
