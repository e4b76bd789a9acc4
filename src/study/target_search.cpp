#include "study/calibrate.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

namespace plica {
namespace {

constexpr double smallest_step = 1e-4;  // where the search has converged
constexpr double smallest_bracket = 1e-8;
constexpr double first_step = 0.2;
constexpr double better = 0.98;      // relative to the best miss so far
constexpr std::size_t patience = 4;  // evaluations without improvement, times n + 1
constexpr double penalty = 2;        // of a point without a value, relative to the worst miss so far
constexpr double unknown = 1e3;      // worst miss before any is known

// Evaluate points and record what both searches need.
class Looker {
 public:
  Looker(std::vector<double> start, std::size_t targets, const LookAt& look)
      : best_(std::move(start)), targets_(targets), look_(look) {}

  const Look& at(const std::vector<double>& place) {
    if (place == place_) return last_;
    place_ = place;
    last_ = look_(place);
    const double miss = worst_miss(last_.misses);
    since_better_ = miss < better * best_miss_ ? 0 : since_better_ + 1;
    if (miss < best_miss_) best_miss_ = miss, best_ = place;
    if (!last_.misses.empty()) worst_miss_ = std::max(worst_miss_, miss);
    return last_;
  }

  [[nodiscard]] std::vector<double> misses_or_penalty() const {
    if (!last_.misses.empty()) return last_.misses;
    return std::vector<double>(targets_, worst_miss_ > 0 ? penalty * worst_miss_ : unknown);
  }

  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] bool over() const { return last_.over; }
  /// Whether no recent evaluation improved notably on all earlier ones.
  [[nodiscard]] bool gets_nowhere() const { return since_better_ > patience * (best_.size() + 1); }

 private:
  std::vector<double> best_, place_;
  std::size_t targets_;
  const LookAt& look_;
  Look last_;
  std::size_t since_better_ = 0;
  double best_miss_ = std::numeric_limits<double>::infinity(), worst_miss_ = 0;  // of evaluations with a value
};

// Search between the bounds. Returns true if they bracket the target and every point had a value: the search is
// complete.
bool search_bracket(Looker& looker) {
  bool all_have_values = true;
  const auto miss = [&](double place) {
    const Look& look = looker.at({place});
    all_have_values = all_have_values && !look.misses.empty();
    return look.over || look.misses.empty() ? 0.0 : look.misses.front();  // 0 ends the search
  };
  const double low = miss(0), high = looker.over() ? 0 : miss(1);
  if (looker.over()) return true;
  if (!all_have_values || low * high > 0) return false;
  std::uintmax_t most = 100;
  const auto narrow = [](double a, double b) { return std::abs(b - a) < smallest_bracket; };
  boost::math::tools::toms748_solve(miss, 0.0, 1.0, low, high, narrow, most);
  return looker.over() || all_have_values;
}

// A miss is an equation, m = 0, given as two inequalities, since NLopt allows at most as many equations as coordinates.
void misses_for_nlopt(unsigned count, double* at_most_0, unsigned dimension, const double* place, double*, void* data) {
  Looker& looker = *static_cast<Looker*>(data);
  looker.at({place, place + dimension});
  if (looker.over() || looker.gets_nowhere()) throw nlopt::forced_stop();
  const std::vector<double> misses = looker.misses_or_penalty();
  for (unsigned i = 0; i < count; ++i) at_most_0[i] = i % 2 == 0 ? misses[i / 2] : -misses[i / 2];
}

double nothing_to_minimise(unsigned, const double*, double*, void*) { return 0; }

void search_linear_models(Looker& looker, std::size_t targets) {
  std::vector<double> place = looker.best();
  nlopt::opt search(nlopt::LN_COBYLA, static_cast<unsigned>(place.size()));
  search.set_lower_bounds(0);
  search.set_upper_bounds(1);
  search.set_min_objective(nothing_to_minimise, nullptr);
  search.add_inequality_mconstraint(misses_for_nlopt, &looker, std::vector<double>(2 * targets, 0));
  search.set_initial_step(first_step);
  search.set_xtol_abs(smallest_step);
  try {
    double unused = 0;
    search.optimize(place, unused);
  } catch (const nlopt::forced_stop&) {       // finished, or nowhere to go
  } catch (const nlopt::roundoff_limited&) {  // improvements are below rounding error
  }
}

}  // namespace

double worst_miss(const std::vector<double>& misses) {
  if (misses.empty()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const double miss : misses) worst = std::max(worst, std::abs(miss));
  return worst;
}

void search_targets(const std::vector<double>& start, std::size_t targets, const LookAt& look) {
  Looker looker(start, targets, look);
  if (start.size() == 1 && targets == 1 && search_bracket(looker)) return;
  if (!looker.over()) search_linear_models(looker, targets);
}

}  // namespace plica
