// Snapshots of a run for its report page: collected, thinned out and packed. viewer/src/packed.ts reads them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "show/looks.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// Collection of integer arrays that compresses well. Each number is stored as its difference from the one `period`
/// earlier (modulo 2^bits), with all lowest bytes of an array first, then the next ones: small changes between
/// snapshots become long runs of equal bytes.
class PackedArrays {
 public:
  template <class Number>  // unsigned, of 16 or 32 bits
  void add(const std::string& name, const std::vector<Number>& values, std::size_t period) {
    const std::size_t count = values.size(), offset = bytes_.size(), size = sizeof(Number);
    index_.push_back({{"name", name}, {"bits", 8 * size}, {"period", period}, {"count", count}, {"offset", offset}});
    bytes_.resize(offset + count * size);
    for (std::size_t i = 0; i < count; ++i) {
      const auto change = static_cast<Number>(i < period ? values[i] : values[i] - values[i - period]);
      for (std::size_t b = 0; b < size; ++b)
        bytes_[offset + b * count + i] = static_cast<char>(change >> (8 * b) & 0xff);
    }
  }

  /// Bytes of all arrays, before compression.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  /// JSON list of {name, bits, period, count, offset} with the position of each array in the bytes.
  [[nodiscard]] const nlohmann::ordered_json& index() const { return index_; }

 private:
  nlohmann::ordered_json index_ = nlohmann::ordered_json::array();
  std::string bytes_;
};

/// Quantization of a range in 65536 equal steps.
struct Quantiser {
  double low = 0, high = 0;
  void include(double value);
  /// Step nearest to a value.
  [[nodiscard]] std::uint16_t step_of(double value) const;

 private:
  bool any_ = false;
};

/// Run as JSON and packed numbers; content: report.hpp.
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
  std::vector<std::uint32_t> cell_of_element, cell_id;
  std::vector<std::size_t> first_element;                                                   // of each cell
  std::vector<std::tuple<std::string, std::vector<std::uint32_t>, std::size_t>> structure;  // name, numbers, period
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
