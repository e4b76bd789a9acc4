#include "mechanics/law.hpp"

#include "mechanics/derivatives.hpp"

namespace plica {

std::unique_ptr<Law> LawChange::restored(const Tissue& tissue, const TissueChange& change,
                                         std::span<const Vec3> positions, std::span<const double> past) const {
  if (!past.empty()) throw InvalidNumbers();
  return after_change(tissue, change, positions);
}

void Law::refuse_gradient(std::string_view why) const { throw NoGradient(label() + ": " + std::string(why)); }

const LawDerivatives& Law::derivatives() const {
  refuse_gradient("this law has no derivatives yet; remove it from the scenario");
}

}  // namespace plica
