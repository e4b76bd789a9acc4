// The embryo itself in the paper's figures 4, 5, 7 and 9 to 11, from finished runs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paper/runs.hpp"
#include "show/chart.hpp"
#include "show/run_pictures.hpp"

namespace plica {

/// Each picture throws FileError where it cannot be drawn: no screen, no VTK, a frame that is missing.
class ReproductionPictures {
 public:
  explicit ReproductionPictures(const Results& results) : results_(results) {}

  Figure division_demo();
  Figure division_sections();

  /// A run at some moments, a row a view, coloured by displacement.
  Figure moments(const std::string& run, const std::vector<std::string>& views, const std::vector<double>& times_s,
                 const std::string& name, const std::string& caption);

 private:
  [[nodiscard]] RunPictures run_pictures(const std::string& run, const std::vector<std::string>& views);
  Figure drawn(const std::string& name, const Picture& picture, const std::string& caption);

  const Results& results_;
  LazyPainter painter_;
  std::optional<ColourRange> displacement_;  // one scale for the pill and the sphere
};

}  // namespace plica
