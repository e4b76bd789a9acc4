// Pictures for the paper's figures 4, 5, 7 and 9 to 11, from finished runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paper/runs.hpp"
#include "show/chart.hpp"
#include "show/run_pictures.hpp"

namespace plica {

/// Pictures; each throws FileError if it cannot be drawn (no screen, no VTK, missing snapshot).
class ReproductionPictures {
 public:
  explicit ReproductionPictures(const Results& results) : results_(results) {}

  Figure division_demo();
  Figure division_sections();

  /// Picture of a run at several times, one row per view, coloured by displacement.
  Figure moments(const std::string& run, const std::vector<std::string>& views, const std::vector<double>& times_s,
                 const std::string& name, const std::string& caption);

 private:
  [[nodiscard]] RunPictures run_pictures(const std::string& run, const std::vector<std::string>& views);
  Figure drawn(const std::string& name, const Picture& picture, const std::string& caption);

  const Results& results_;
  LazyPainter painter_;
  std::optional<ColourRange> displacement_;  // common scale of pill and sphere
};

}  // namespace plica
