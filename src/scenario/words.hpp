// Words allowed as values, with their meanings, one table per key. Rows of keys take the allowed words from here, and
// code that builds from a scenario the meanings.
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "measure/monitor.hpp"
#include "measure/stop_rule.hpp"
#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/fibres.hpp"
#include "mechanics/active/shape_activation.hpp"
#include "scenario/scenario.hpp"
#include "solver/make_stepper.hpp"
#include "tissue/prisms.hpp"
#include "tissue/tissue.hpp"

namespace plica {

template <class Meaning>
struct Word {
  std::string_view word;
  Meaning meaning;
};

/// Returns the words of a table, in order.
template <class Words>
std::vector<std::string_view> words_of(const Words& table) {
  std::vector<std::string_view> words;
  words.reserve(std::size(table));
  for (const auto& entry : table) words.push_back(entry.word);
  return words;
}

/// Returns the meaning of a word. Throws std::logic_error for words not in the table, which reading has rejected.
template <class Meaning, std::size_t n>
Meaning meaning_of(const std::array<Word<Meaning>, n>& table, std::string_view word) {
  for (const Word<Meaning>& entry : table)
    if (entry.word == word) return entry.meaning;
  throw std::logic_error("no word of this key: " + std::string(word));
}

/// Returns the meaning of a word, or a default for a key that is not set.
template <class Meaning, std::size_t n>
Meaning meaning_of(const std::array<Word<Meaning>, n>& table, std::string_view word, Meaning when_not_given) {
  return word.empty() ? when_not_given : meaning_of(table, word);
}

namespace words {

inline constexpr auto axes = std::to_array<Word<int>>({{"x", 0}, {"y", 1}, {"z", 2}});

// [embryo]
inline constexpr auto mirror_planes = std::to_array<Word<int>>({{"x", 0}, {"y", 1}});

// [region.NAME]
inline constexpr auto sides = std::to_array<Word<GridPlace::Face>>({{"ventral", GridPlace::Face::ventral},
                                                                    {"dorsal", GridPlace::Face::dorsal},
                                                                    {"left", GridPlace::Face::left},
                                                                    {"right", GridPlace::Face::right},
                                                                    {"anterior", GridPlace::Face::anterior},
                                                                    {"posterior", GridPlace::Face::posterior}});

inline constexpr auto embryo_shapes = std::to_array<Word<EmbryoShape>>({{"pill", EmbryoShape::pill},
                                                                        {"sphere", EmbryoShape::sphere},
                                                                        {"slice", EmbryoShape::slice},
                                                                        {"block", EmbryoShape::block},
                                                                        {"egg", EmbryoShape::egg},
                                                                        {"points", EmbryoShape::points},
                                                                        {"sheet", EmbryoShape::sheet},
                                                                        {"surface", EmbryoShape::surface},
                                                                        {"prisms", EmbryoShape::prisms},
                                                                        {"file", EmbryoShape::file}});

inline constexpr auto polygon_splits =
    std::to_array<Word<PolygonSplit>>({{"diagonals", PolygonSplit::diagonals}, {"kites", PolygonSplit::kites}});

inline constexpr auto periods = std::to_array<Word<int>>({{"x", 0}, {"y", 1}});
inline constexpr auto rims = std::to_array<Word<bool>>({{"free", false}, {"held", true}});  // whether it is fixed

inline constexpr auto elastic_models =
    std::to_array<Word<ElasticModel>>({{"corotational", ElasticModel::corotational},
                                       {"neo-hookean", ElasticModel::neo_hookean},
                                       {"shape-memory", ElasticModel::shape_memory}});

// [volume]
inline constexpr auto volume_methods = std::to_array<Word<VolumeMethod>>(
    {{"coupled", VolumeMethod::coupled}, {"projection", VolumeMethod::projection}, {"none", VolumeMethod::none}});
inline constexpr auto projection_surfaces =
    std::to_array<Word<ProjectionRule::Surfaces>>({{"cells", ProjectionRule::Surfaces::cells},
                                                   {"tissue", ProjectionRule::Surfaces::tissue},
                                                   {"embryo", ProjectionRule::Surfaces::embryo}});
inline constexpr auto projection_weights = std::to_array<Word<ProjectionRule::Weights>>(
    {{"equal", ProjectionRule::Weights::equal}, {"mobility", ProjectionRule::Weights::mobility}});

// [embryo] keep: whether only the largest piece is kept.
inline constexpr auto keeps = std::to_array<Word<bool>>({{"all", false}, {"largest", true}});

// [contraction.NAME]
inline constexpr auto edges = std::to_array<Word<CellSide>>(
    {{"apical", CellSide::apical}, {"basal", CellSide::basal}, {"lateral", CellSide::lateral}});
inline constexpr auto profile_shapes =
    std::to_array<Word<StrengthProfile::Shape>>({{"constant", StrengthProfile::Shape::constant},
                                                 {"linear", StrengthProfile::Shape::linear},
                                                 {"gaussian", StrengthProfile::Shape::gaussian},
                                                 {"plateau", StrengthProfile::Shape::plateau},
                                                 {"table", StrengthProfile::Shape::table},
                                                 {"array", StrengthProfile::Shape::array}});
inline constexpr auto profile_axes = std::to_array<Word<PatternAxis>>(
    {{"across", PatternAxis::across}, {"along", PatternAxis::along}, {"angle", PatternAxis::angle}});
// Whether factors depend on position, and whether all cells share one phase.
inline constexpr auto variation_bys = std::to_array<Word<bool>>({{"number", false}, {"place", true}});
inline constexpr auto pulse_phases = std::to_array<Word<bool>>({{"random", false}, {"together", true}});
inline constexpr auto delay_axes =
    std::to_array<Word<PatternAxis>>({{"along", PatternAxis::along}, {"across", PatternAxis::across}});
inline constexpr auto delay_starts = std::to_array<Word<StartDelay::From>>({{"middle", StartDelay::From::middle},
                                                                            {"ends", StartDelay::From::ends},
                                                                            {"low", StartDelay::From::low},
                                                                            {"high", StartDelay::From::high}});

// [cortex.NAME], in addition to those above.
inline constexpr auto cell_measures =
    std::to_array<Word<ShapeMeasure>>({{shape_measure_names[0], ShapeMeasure::apical_area_ratio},
                                       {shape_measure_names[1], ShapeMeasure::basal_area_ratio},
                                       {shape_measure_names[2], ShapeMeasure::height_ratio},
                                       {shape_measure_names[3], ShapeMeasure::apical_stretch},
                                       {"stress_Pa", ShapeMeasure::passive_stress}});
inline constexpr auto fibre_axes = std::to_array<Word<FibreAxis>>({{"along", FibreAxis::along},
                                                                   {"across", FibreAxis::across},
                                                                   {"long-axis", FibreAxis::long_axis},
                                                                   {"stretch", FibreAxis::stretch}});
// Whether a cell reads its neighbours.
inline constexpr auto read_cells = std::to_array<Word<bool>>({{"cell", false}, {"neighbours", true}});

// [pressure.NAME]: whether the face is apical.
inline constexpr auto surfaces =
    std::to_array<Word<CellSide>>({{"apical", CellSide::apical}, {"basal", CellSide::basal}});

// [enclosed.NAME]
inline constexpr auto enclosed_states = std::to_array<Word<EnclosedState>>(
    {{"held", EnclosedState::held}, {"compliant", EnclosedState::compliant}, {"free", EnclosedState::free}});

// [self_contact]
inline constexpr auto contact_surfaces = std::to_array<Word<ContactSurface>>({{"none", ContactSurface::none},
                                                                              {"apical", ContactSurface::apical},
                                                                              {"basal", ContactSurface::basal},
                                                                              {"both", ContactSurface::both}});

// [division.NAME]
inline constexpr auto division_triggers =
    std::to_array<Word<DivisionTrigger>>({{"area_above_um2", DivisionTrigger::apical_area},
                                          {"volume_above_um3", DivisionTrigger::volume},
                                          {"elongation_above", DivisionTrigger::elongation}});
inline constexpr auto division_planes =
    std::to_array<Word<DivisionPlane>>({{"transverse", DivisionPlane::transverse},
                                        {"sagittal", DivisionPlane::sagittal},
                                        {"longest-axis", DivisionPlane::longest_axis}});

// [time]
inline constexpr auto schemes = std::to_array<Word<StepScheme::Forces>>(
    {{"newton", StepScheme::Forces::newton}, {"linearly-implicit", StepScheme::Forces::linearly_implicit}});
// Loading a scenario replaces "automatic" by one of the others.
inline constexpr auto integrators = std::to_array<Word<std::optional<TimeOrder>>>(
    {{"automatic", std::nullopt}, {"backward-euler", TimeOrder::first}, {"bdf2", TimeOrder::second}});
inline constexpr auto linear_solvers = std::to_array<Word<LinearMethod>>({{"automatic", LinearMethod::automatic},
                                                                          {"direct", LinearMethod::direct},
                                                                          {"cholesky", LinearMethod::cholesky},
                                                                          {"multigrid", LinearMethod::multigrid}});

// [stop]: whether all criteria must be met. [stop.NAME]: whether any or all values of a monitor must pass.
inline constexpr auto combinations = std::to_array<Word<bool>>({{"any", false}, {"all", true}});
inline constexpr auto criterion_overs =
    std::to_array<Word<Criterion::Over>>({{"any", Criterion::Over::any}, {"all", Criterion::Over::all}});

// [monitor.NAME]
inline constexpr auto overs = std::to_array<Word<Over>>(
    {{"mean", Over::mean}, {"max", Over::max}, {"min", Over::min}, {"sum", Over::sum}, {"rms", Over::rms}});
inline constexpr auto reference_times = std::to_array<Word<Monitor::ReferenceAt>>(
    {{"same-time", Monitor::ReferenceAt::same_time}, {"end", Monitor::ReferenceAt::end}});

}  // namespace words

inline PolygonSplit split_of(const EmbryoInput& embryo) { return meaning_of(words::polygon_splits, embryo.elements); }
/// Whether cells lie on a grid and have named sides.
inline bool is_of_grid(EmbryoShape shape) {
  return shape == EmbryoShape::pill || shape == EmbryoShape::sphere || shape == EmbryoShape::slice ||
         shape == EmbryoShape::block;
}
/// Whether a file defines the cells; it may have cell arrays.
inline bool is_from_file(EmbryoShape shape) {
  return shape == EmbryoShape::file || shape == EmbryoShape::points || shape == EmbryoShape::surface ||
         shape == EmbryoShape::prisms;
}
/// Whether the shape is always open, so it encloses no volume.
inline bool is_patch(EmbryoShape shape) { return shape == EmbryoShape::block || shape == EmbryoShape::sheet; }
inline EmbryoShape shape_of(const EmbryoInput& embryo) { return meaning_of(words::embryo_shapes, embryo.shape); }
inline ElasticModel model_of(const ElasticityInput& input) { return meaning_of(words::elastic_models, input.model); }
inline VolumeMethod method_of(const VolumeInput& volume) { return meaning_of(words::volume_methods, volume.method); }
/// Whether time steps or volumes follow the paper's algorithm instead of Newton's method with volume constraints.
inline bool is_as_in_the_paper(const Scenario& scenario) {
  return method_of(scenario.volume) == VolumeMethod::projection || scenario.time.scheme != "newton";
}
/// What second order in time does not support in a scenario; empty if nothing.
inline std::string what_bars_second_order(const Scenario& scenario) {
  if (scenario.time.scheme != "newton") return "time.scheme = \"" + scenario.time.scheme + '"';
  if (method_of(scenario.volume) == VolumeMethod::projection) return "volume.method = \"projection\"";
  return scenario.dynamics.density_kg_per_m3 > 0 ? "dynamics.density_kg_per_m3 above 0" : "";
}

}  // namespace plica
