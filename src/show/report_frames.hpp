// The frames of a run as the page of its report holds them: gathered while they come, thinned, packed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "show/looks.hpp"
#include "show/packing.hpp"
#include "show/skin.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// A run as JSON and packed numbers: report_run.hpp says what is in them.
struct ReportRun {
  nlohmann::ordered_json json;
  PackedArrays frames;
  std::map<std::string, Quantiser> fields;  // range of each field over the frames, by its name
  std::vector<View> views = plica::views();
  std::vector<ColourField> colours = colour_fields();
};

/// What is shown of one frame, until all are known and can be told in whole numbers.
struct FrameMoment {
  double time_s = 0;
  std::size_t number = 0;    // of the frame in the run
  bool at_division = false;  // the first with new cells, or the last without them: it stays
  std::vector<std::array<float, 3>> positions;
  std::vector<std::vector<float>> fields;  // in the order of ReportFrames' fields; a value a node or a cell
};

/// The frames between two divisions: the same cells of the same elements.
struct FrameTopology {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<std::uint32_t> cell_of_element, cell_id, mother_id, generation, regions;
  std::vector<std::size_t> first_element;  // of each cell
  Skin skin;
  std::vector<FrameMoment> moments;
};

class ReportFrames {
 public:
  /// `most_bytes`: what the kept frames may take before compression. Where they take more, only every second of the
  /// run's frames stays, then every fourth, and so on; always the last one and those on both sides of a division.
  explicit ReportFrames(double most_bytes) : most_bytes_(most_bytes) {}

  /// Frames in the order of time. FileError when one lacks an array that every frame of plica has.
  void add(const Frame& frame, double time_s);

  [[nodiscard]] bool empty() const { return topologies_.empty(); }
  [[nodiscard]] const Vectors& rest_positions() const { return rest_positions_; }  // of the first frame, um

  /// Puts the frames into the run: `frames_saved`, `every`, `box`, `fields`, `regions`, `coloured_regions`,
  /// `topologies`, `arrays`.
  void pack_into(ReportRun& run) const;

 private:
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
