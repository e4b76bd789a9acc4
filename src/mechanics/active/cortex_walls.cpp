// Factors on the tension of single lateral faces, set from outside. They are part of the internal state, before given
// activities, which are set whenever they are, so that lengths tell what is there.
#include "mechanics/active/cortex.hpp"

namespace plica {

bool Cortex::accepts(std::span<const double> internal, const Tissue& tissue) const {
  const std::size_t own = first_internal(tissue).size();
  return internal.size() == own || internal.size() == own + faces_.size() + pattern_.cells.size();
}

std::vector<double> Cortex::with_activities(std::span<const double> internal,
                                            std::span<const double> activities) const {
  const Memory now = memory(internal);
  const std::vector<double> programmed(now.factors.empty() ? 0 : pattern_.cells.size(), GivenActivities::as_programmed);
  return now.given.put(internal, activities.empty() ? programmed : activities);
}

std::vector<double> Cortex::with_face_factors(std::span<const double> internal, std::span<const double> factors) const {
  const Memory now = memory(internal);
  const std::span<const double> given = now.given.internal();
  const std::size_t own = internal.size() - now.factors.size() - given.size();
  std::vector<double> result(internal.begin(), internal.begin() + static_cast<std::ptrdiff_t>(own));
  result.insert(result.end(), factors.begin(), factors.end());
  result.insert(result.end(), given.begin(), given.end());
  if (given.empty() && !factors.empty())
    result.insert(result.end(), pattern_.cells.size(), GivenActivities::as_programmed);
  return result;
}

double Cortex::factor_of(std::size_t face, const Step& step) const {
  const std::span<const double> given = memory(step.internal).factors;
  return (rule_.walls.is_used() ? factors_.of_face[face] : 1) * (given.empty() ? 1 : given[face]);
}

}  // namespace plica
