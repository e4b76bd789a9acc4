// Snapshots of a run for its report page: collected, thinned out and packed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "show/boundary_surface.hpp"
#include "show/looks.hpp"
#include "show/packing.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// Run as JSON and packed numbers; content: report_run.hpp.
struct ReportRun {
  nlohmann::ordered_json json;
  PackedArrays frames;
  std::map<std::string, Quantiser> fields;  // range of each field over all snapshots, by name
  std::vector<View> views = plica::views();
  std::vector<ColourField> colours = colour_fields();
};

/// Data of one snapshot, kept as floats until all are known and can be quantized.
struct FrameMoment {
  double time_s = 0;
  std::size_t number = 0;    // number of the snapshot in the run
  bool at_division = false;  // first with new cells or last without them; always kept
  std::vector<std::array<float, 3>> positions;
  std::vector<std::vector<float>> fields;  // in the order of ReportFrames' fields; nodes or cells
};

/// Snapshots between two divisions, with equal cells and elements.
struct FrameTopology {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<std::uint32_t> cell_of_element, cell_id, mother_id, generation, regions;
  std::vector<std::size_t> first_element;  // of each cell
  BoundarySurface boundary;
  std::vector<FrameMoment> moments;
};

class ReportFrames {
 public:
  /// `most_bytes`: limit of the kept snapshots before compression. Beyond it every second snapshot is kept, then every
  /// fourth, and so on; always the last one and those around a division.
  explicit ReportFrames(double most_bytes) : most_bytes_(most_bytes) {}

  /// Add snapshots in order of time. Throws FileError for a missing standard array.
  void add(const Frame& frame, double time_s);

  [[nodiscard]] bool empty() const { return topologies_.empty(); }
  [[nodiscard]] const Vectors& rest_positions() const { return rest_positions_; }  // of the first frame, um

  /// Add the snapshots to the run: `frames_saved`, `every`, `box`, `fields`, `regions`, `coloured_regions`,
  /// `topologies`, `arrays`.
  void pack_into(ReportRun& run) const;

 private:
  /// Add the arrays that the frame is the first to have, with 0 in snapshots before it.
  void add_new_fields(const Frame& frame);
  void thin_out();

  double most_bytes_, bytes_ = 0;
  std::size_t seen_ = 0, every_ = 1;
  std::vector<std::string> regions_, coloured_regions_;
  std::vector<View> views_;
  std::vector<ColourField> fields_;
  std::vector<FrameTopology> topologies_;
  Vectors rest_positions_;
};

}  // namespace plica
