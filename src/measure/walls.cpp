#include "measure/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/energy.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

// Cells of a face, the lower first; -1 for none.
using WallKey = std::pair<int, int>;

WallKey key_of(const Face& face) {
  if (!face.beyond) return {face.cell.number(), -1};
  return std::minmax(face.cell.number(), face.beyond->number());
}

std::map<WallKey, std::size_t> places_of_walls(const Tissue& tissue) {
  std::map<WallKey, std::size_t> places;
  for (const Face& face : faces_of(tissue, CellSide::lateral)) places[key_of(face)] = 0;
  std::size_t next = 0;
  for (auto& [key, place] : places) place = next++;
  return places;
}

const Cortex& lateral_cortex(const Model& model, const std::string& label) {
  const Cortex* cortex = model.laws[place_of_law(model, label, true)]->cortex();
  if (cortex == nullptr || cortex->side() != CellSide::lateral)
    throw UsageError(fmt::format("{}: does not act on lateral faces; name a cortex with faces = \"lateral\"", label));
  return *cortex;
}

// Mean distance of two columns at base and apex.
double distance(const Vertex& one, const Vertex& other, std::span<const Vec3> positions) {
  const auto between = [&](NodeId a, NodeId b) { return (positions[b.index()] - positions[a.index()]).norm(); };
  return 0.5 * (between(one.nodes.front(), other.nodes.front()) + between(one.nodes.back(), other.nodes.back()));
}

}  // namespace

std::vector<MeasuredWall> measured_walls(const Model& model, const State& state) {
  const std::map<WallKey, std::size_t> places = places_of_walls(model.tissue);
  std::vector<MeasuredWall> walls;
  for (const auto& [key, place] : places)
    walls.push_back({.cell = CellId(static_cast<std::size_t>(key.first)),
                     .other = key.second < 0 ? std::nullopt : std::optional(CellId(key.second))});
  for (const Face& face : faces_of(model.tissue, CellSide::lateral))
    walls[places.at(key_of(face))].area_um2 += facet_area(gather(std::span<const Vec3>(state.positions), face.nodes));
  const Sheet& sheet = model.tissue.sheet;
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (std::size_t i = 0; i < sheet.cells[c].ring.size(); ++i) {
      const Stop &from = sheet.cells[c].ring[i], &to = sheet.cells[c].after(i);
      const CellId beyond = sheet.walls[from.wall.index()].beyond(CellId(c));
      if (beyond.valid() && beyond < CellId(c)) continue;
      walls[places.at({static_cast<int>(c), beyond.valid() ? beyond.number() : -1})].length_um +=
          distance(sheet.vertices[from.vertex.index()], sheet.vertices[to.vertex.index()], state.positions);
    }
  for_laws(model, motionless(state, state.velocities), [&](const Law& law, const Step& law_step) {
    const Cortex* cortex = law.cortex();
    if (cortex == nullptr || cortex->side() != CellSide::lateral) return;
    const std::vector<double> areas = cortex->areas(state.positions), tensions = cortex->tensions(law_step);
    for (std::size_t f = 0; f < areas.size(); ++f) {
      MeasuredWall& wall = walls[places.at(key_of(cortex->faces()[f]))];
      wall.tension += tensions[f] * areas[f] / wall.area_um2;
    }
  });
  return walls;
}

std::vector<double> wall_factors(const Model& model, const State& state, const std::string& label) {
  const Cortex& cortex = lateral_cortex(model, label);
  const std::map<WallKey, std::size_t> places = places_of_walls(model.tissue);
  const std::span<const double> given = cortex.face_factors(state.internals[place_of_law(model, label)]);
  std::vector<double> factors(places.size(), 1.0);
  for (std::size_t f = 0; f < given.size(); ++f) factors[places.at(key_of(cortex.faces()[f]))] = given[f];
  return factors;
}

std::vector<double> with_wall_factors(const Model& model, const State& state, const std::string& label,
                                      std::span<const double> factors) {
  const Cortex& cortex = lateral_cortex(model, label);
  const std::map<WallKey, std::size_t> places = places_of_walls(model.tissue);
  if (!factors.empty() && factors.size() != places.size())
    throw UsageError(fmt::format("{}: {} factors for {} walls; give one per wall, in the order of the table of walls",
                                 label, factors.size(), places.size()));
  for (const auto& [key, place] : places)
    if (!factors.empty() && !(factors[place] >= 0 && std::isfinite(factors[place])))
      throw UsageError(fmt::format("{}: the factor of wall {} (cells {} and {}) is {}; give a number >= 0", label,
                                   place, key.first, key.second, factors[place]));
  std::vector<double> of_faces;
  if (!factors.empty())
    for (const Face& face : cortex.faces()) of_faces.push_back(factors[places.at(key_of(face))]);
  return cortex.with_face_factors(state.internals[place_of_law(model, label)], of_faces);
}

}  // namespace plica
