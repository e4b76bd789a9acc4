#include "mechanics/derivatives.hpp"

namespace plica {

void Law::refuse_gradient(std::string_view why) const { throw NoGradient(label() + ": " + std::string(why)); }

const LawDerivatives& Law::derivatives() const {
  refuse_gradient("this law has no derivatives yet; remove it from the scenario");
}

const LawDerivatives& static_derivatives() {
  static const LawDerivatives derivatives;
  return derivatives;
}

std::unique_ptr<Law> with_strengths(const Law& law, std::span<const double> factors) {
  std::unique_ptr<Law> scaled = law.derivatives().with_strengths(factors);
  if (!scaled) throw UsageError(law.label() + ": has no strengths of cells; choose a contraction or a cortex");
  scaled->set_label(law.label());
  return scaled;
}

}  // namespace plica
