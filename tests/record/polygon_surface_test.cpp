#include "record/polygon_surface.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "core/errors.hpp"
#include "measure/furrow.hpp"
#include "simulation/division_rules.hpp"
#include "support/prisms.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

using namespace support;

Frame frame_of_tissue(const Tissue& tissue) {
  const FramePolygons polygons = polygons_of(tissue);
  MeshArrays arrays;
  std::vector<double> numbers;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) numbers.push_back(10.0 * static_cast<double>(c));
  arrays.cell_scalars.emplace_back("number", numbers);
  arrays.polygons = &polygons;
  return frame_of(tissue, tissue.rest_positions, arrays);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Whatever elements a cell is made of, its polygon has its corners; nodes within edges are no vertices.
TEST(SurfaceMesh, IsThatOfTheCells) {
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites})
    for (const int layers : {1, 2}) {
      const PrismSheet sheet = irregular_polygons(6, 5, 4, 12, 0.1, 3);
      const Tissue tissue = tissue_from_prisms(sheet, split, layers);
      for (const bool apical : {true, false}) {
        const SurfaceMesh surface = surface_of(frame_of_tissue(tissue), apical);
        EXPECT_EQ(surface.points.size(), sheet.apical.size());
        ASSERT_EQ(surface.ends.size(), sheet.cells.size());
        std::size_t corner = 0;
        for (std::size_t c = 0; c < sheet.cells.size(); ++c) {
          ASSERT_EQ(static_cast<std::size_t>(surface.ends[c]) - corner, sheet.cells[c].size());
          for (const std::size_t vertex : sheet.cells[c])
            EXPECT_EQ(surface.points[surface.corners[corner++]], (apical ? sheet.apical : sheet.basal)[vertex]);
          EXPECT_EQ(surface.scalars.at(0).second[c], 10.0 * static_cast<double>(c));
        }
      }
    }
}

// A wall is the same line in both of its cells, also where one of them was cut: no vertex lies beside an edge, no edge
// within the tissue has one side, and areas are those of the cells.
TEST(SurfaceMesh, OfDividedCellsHasNoGaps) {
  Tissue tissue = tissue_from_prisms(irregular_polygons(6, 6, 8, 12, 0.1, 3), PolygonSplit::diagonals, 1);
  Vectors positions = tissue.rest_positions;
  for (int round = 0; round < 2; ++round) {
    std::vector<CellCut> cuts;
    for (std::size_t c = 7; c < tissue.cells.size(); c += 4)
      cuts.push_back(cut_by(DivisionPlane::longest_axis, tissue, CellId(c), positions));
    const Division division = divide(tissue, cuts, 0, positions);
    positions = with_new_nodes(tissue, division, positions);
    for (Vec3& x : positions) x += Vec3(0.3 * std::sin(x.y()), 0.3 * std::cos(2 * x.x()), 0);
    tissue.place_hanging(positions);
  }
  Frame frame = frame_of_tissue(tissue);
  frame.positions = positions;
  for (const bool apical : {true, false}) {
    const SurfaceMesh surface = surface_of(frame, apical);
    std::set<std::pair<int, int>> edges;
    std::vector<double> areas;
    int first = 0;
    for (const int end : surface.ends) {
      double area = 0;
      for (int i = first; i < end; ++i) {
        const int from = surface.corners[i], to = surface.corners[i + 1 < end ? i + 1 : first];
        EXPECT_TRUE(edges.emplace(from, to).second);
        area += 0.5 * surface.points[from].cross(surface.points[to]).z();
      }
      areas.push_back(area);
      first = end;
    }
    const auto lonely = std::ranges::count_if(edges, [&](const auto& edge) {
      return !edges.contains({edge.second, edge.first});
    });
    EXPECT_EQ(lonely, static_cast<long>(rim_of(tissue, apical ? tissue.apical_facets : tissue.basal_facets).size()));
    const std::vector<double> of_cells = apical ? apical_areas(tissue, positions) : basal_areas(tissue, positions);
    for (std::size_t c = 0; c < areas.size(); ++c) EXPECT_NEAR(areas[c], of_cells[c], 1e-9 * of_cells[c]) << c;
  }
}

TEST(SurfaceMesh, TablesNameVerticesEdgesAndFaces) {
  // Two squares of 20 x 20 beside each other.
  const Tissue block = build_block(
      {.length_um = 40, .width_um = 20, .cell_height_um = 20, .cells = {2, 1, 1}, .elements_per_cell = {2, 2, 2}});
  const auto [vertices, edges, faces] = tables_of(surface_of(frame_of_tissue(block), true));
  const std::vector<std::string> of_vertices = lines_of(vertices), of_edges = lines_of(edges),
                                 of_faces = lines_of(faces);
  ASSERT_EQ(of_vertices.size(), 7u);
  ASSERT_EQ(of_edges.size(), 9u);
  ASSERT_EQ(of_faces.size(), 3u);
  EXPECT_EQ(of_edges[0], "edge,srce,trgt,face,opposite,dx,dy,dz,length");
  EXPECT_EQ(of_edges[1], "0,0,1,0,-1,20,0,0,20");
  EXPECT_EQ(of_edges[2], "1,1,2,0,7,0,20,0,20");
  EXPECT_EQ(of_edges[8], "7,2,1,1,1,0,-20,0,20");
  EXPECT_EQ(of_faces[0], "face,x,y,z,num_sides,area,perimeter,number");
  EXPECT_EQ(of_faces[2].substr(0, 8), "1,10,0,1");
  EXPECT_EQ(of_faces[2].substr(of_faces[2].size() - 12), ",4,400,80,10");
}

TEST(SurfaceMesh, OfCellsOfOneElementIsThatOfTheirFaces) {
  const Tissue pill = build_shell({.length_um = 300, .diameter_um = 160, .cell_height_um = 30, .cells = {6, 4, 4}});
  const Frame with = frame_of_tissue(pill);
  Frame without = with;
  without.polygons = {};
  for (std::size_t e = 0; e < pill.elements.size(); ++e)
    without.element_scalars["cell_id"].push_back(static_cast<double>(e));
  for (const bool apical : {true, false}) {
    const SurfaceMesh a = surface_of(with, apical), b = surface_of(without, apical);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.corners, b.corners);
  }
  without.element_scalars["cell_id"].back() = 0;
  EXPECT_THROW(surface_of(without, true), FileError);
}

TEST(SurfaceMesh, WhatIsDamagedIsRefused) {
  const Tissue block = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 20, .cells = {2, 1, 1}});
  const Frame good = frame_of_tissue(block);
  EXPECT_NO_THROW(surface_of(good, true));
  int cases = 0;
  const auto refuse = [&](const auto& damage) {
    Frame bad = good;
    damage(bad.polygons);
    EXPECT_THROW(surface_of(bad, true), FileError) << ++cases;
  };
  refuse([](FramePolygons& p) { p = {}; });
  refuse([](FramePolygons& p) { p.apical[3] = 999; });
  refuse([](FramePolygons& p) { p.apical[3] = -1; });
  refuse([](FramePolygons& p) { p.basal.pop_back(); });
  refuse([](FramePolygons& p) { p.ends[0] = 99; });
  refuse([](FramePolygons& p) { p.ends[0] = 1; });
  refuse([](FramePolygons& p) { p.ends.pop_back(); });
  refuse([](FramePolygons& p) { p.elements[1] = 2; });
}

}  // namespace
}  // namespace plica
