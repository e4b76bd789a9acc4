#include "record/frame_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/names.hpp"

namespace plica {
namespace {

constexpr const char *cells_csv = "cells.csv", *midline_csv = "midline.csv", *section_csv = "cross_section.csv";

void add_to_frame(const CellColumn& column, std::vector<double> values, FrameRecord& frame) {
  if (column.none_in_frames)
    std::ranges::replace_if(
        values, [](double value) { return std::isnan(value); }, *column.none_in_frames);
  const std::string name(column.name);
  if (column.in_frames == InFrames::numbers)
    frame.scalars.emplace_back(name, std::move(values));
  else if (column.in_frames == InFrames::integers)
    frame.integers.emplace_back(name, std::vector<int>(values.begin(), values.end()));
}

}  // namespace

FrameCells::FrameCells(const Tissue& tissue)
    : elements(tissue.elements),
      element_cell(tissue.element_cell),
      cells(tissue.cells.size()),
      nodes(tissue.node_count()),
      polygons(polygons_of(tissue)) {
  for (const auto& [name, set] : tissue.regions)
    regions.emplace_back("region_" + name, std::vector<int>(set.begin(), set.end()));
  for (const auto& [name, values] : tissue.cell_arrays)
    if (!is_plicas(name) && std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
      given.emplace_back(name, values);
}

MeshElements FrameRecord::mesh() const { return {cells->elements, cells->element_cell, cells->cells, cells->nodes}; }

MeshArrays FrameRecord::arrays() const {
  MeshArrays arrays{{vectors.begin(), vectors.end()}, scalars, integers};
  // Polygons of single-element cells are the faces of the element.
  if (cells->elements.size() > cells->cells) arrays.polygons = &cells->polygons;
  arrays.cell_scalars.insert(arrays.cell_scalars.end(), cells->given.begin(), cells->given.end());
  arrays.cell_integers.insert(arrays.cell_integers.end(), cells->regions.begin(), cells->regions.end());
  return arrays;
}

FrameTaker::FrameTaker(const Model& model, const FurrowSites* sites, bool with_cell_rows)
    : sites_(sites), with_cell_rows_(with_cell_rows) {
  for (const SignalRule& rule : model.signals.rules()) signal_arrays_.push_back(array_of_signal(rule.name));
  follow_division(model.tissue);
}

std::map<std::string, std::vector<std::string>> FrameTaker::tables() const {
  std::map<std::string, std::vector<std::string>> headers;
  if (with_cell_rows_) {
    headers[cells_csv] = cells_csv_names();
    std::ranges::copy(signal_arrays_, std::back_inserter(headers[cells_csv]));
  }
  if (sites_ != nullptr) headers[midline_csv] = names_of(midline_columns());
  if (sites_ != nullptr) headers[section_csv] = names_of(section_columns());
  return headers;
}

void FrameTaker::follow_division(const Tissue& tissue) {
  cells_ = std::make_shared<const FrameCells>(tissue);
  if (sites_ != nullptr) section_cells_ = section_cells(tissue, sites_->outward);
}

FrameRecord FrameTaker::take(const Model& model, const State& state,
                             const std::map<std::string, CellArray>& outside) const {
  FrameRecord frame{state.time_s, cells_, state.positions, {}, {}, {}, {}};
  for (const NodeColumn& column : node_columns()) frame.vectors.emplace_back(column.name, column.values(model, state));
  const MeasuredCells measured(model, state);
  add_cells(measured, frame);
  for (std::size_t s = 0; s < state.signals.size(); ++s) {
    frame.scalars.emplace_back(signal_arrays_[s], state.signals[s]);
    if (with_cell_rows_) frame.columns[cells_csv].push_back(state.signals[s]);
  }
  frame.scalars.insert(frame.scalars.end(), outside.begin(), outside.end());
  if (sites_ != nullptr) add_fold(measured, frame);
  return frame;
}

void FrameTaker::add_cells(const MeasuredCells& measured, FrameRecord& frame) const {
  for (const CellColumn& column : cell_columns()) {
    const bool in_csv = column.in_csv && with_cell_rows_;
    if (!in_csv && column.in_frames == InFrames::nothing) continue;
    std::vector<double> values = column.values(measured);
    if (in_csv) frame.columns[cells_csv].push_back(values);
    add_to_frame(column, std::move(values), frame);
  }
}

void FrameTaker::add_fold(const MeasuredCells& measured, FrameRecord& frame) const {
  for (const MidlineColumn& column : midline_columns())
    frame.columns[midline_csv].push_back(column.values(measured, *sites_));
  std::vector<CellId> cells;
  for (const SectionCell& one : section_cells_) cells.push_back(one.cell);
  const std::vector<FaceShape> shapes = apical_shapes(measured.model.tissue, cells, measured.state.positions);
  for (const SectionColumn& column : section_columns())
    frame.columns[section_csv].push_back(column.values({measured, section_cells_, shapes}));
}

}  // namespace plica
