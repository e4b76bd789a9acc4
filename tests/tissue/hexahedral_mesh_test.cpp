// Tissues from hexahedra, grouped elements and prisms.
#include "tissue/hexahedral_mesh.hpp"

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "support/same_tissue.hpp"
#include "support/whole.hpp"
#include "tissue/files/child_reading.hpp"
#include "tissue/mesh_quality.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

HexahedralMesh mesh_of(const Tissue& tissue) { return {tissue.rest_positions, tissue.elements, {}, {}}; }

std::string mesh_error(const HexahedralMesh& mesh) {
  return error_of<MeshError>([&] { return tissue_from_mesh(mesh, {1, 1, 1}); });
}

const Tissue& small_shell() {
  static const Tissue shell = build_shell({460, 280, 40, {4, 3, 3}, {1, 1, 1}});
  return shell;
}

double total_volume(const Tissue& tissue) {
  double sum = 0;
  for (const auto& element : tissue.elements) sum += hex_volume(gather(tissue.rest_positions, element));
  return sum;
}

/// The 24 orders of a hexahedron's nodes that turn it without mirroring it.
std::vector<std::array<int, 8>> turns() {
  std::vector<std::array<int, 8>> found;
  for (const auto& top : hex_faces)
    for (int start = 0; start < 4; ++start) {
      std::array<int, 8> turn{};
      for (int i = 0; i < 4; ++i) {
        turn[4 + i] = top[(start + i) % 4];
        for (const auto& [a, b] : hex_edges) {
          const auto outside = [&](int node) { return std::find(top.begin(), top.end(), node) == top.end(); };
          if (a == turn[4 + i] && outside(b)) turn[i] = b;
          if (b == turn[4 + i] && outside(a)) turn[i] = a;
        }
      }
      found.push_back(turn);
    }
  return found;
}

TEST(TissueFromMesh, FindsTheOutsideHoweverTheCellsAreTurned) {
  HexahedralMesh mesh = mesh_of(small_shell());
  std::mt19937 random(1);
  for (auto& cell : mesh.cells) {
    const std::array<int, 8> turn = turns()[random() % 24];
    const auto former = cell;
    for (int i = 0; i < 8; ++i) cell[i] = former[turn[i]];
  }
  const Tissue tissue = tissue_from_mesh(mesh, {2, 2, 3});
  const Tissue expected = tissue_from_mesh(mesh_of(small_shell()), {2, 2, 3});
  EXPECT_EQ(tissue.node_count(), expected.node_count());
  EXPECT_NEAR(total_volume(tissue), total_volume(small_shell()), 1e-12 * total_volume(small_shell()));
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const auto sorted = [](const std::vector<NodeId>& nodes, int from) {
      std::array<NodeId, 4> four{nodes[from], nodes[from + 1], nodes[from + 2], nodes[from + 3]};
      std::sort(four.begin(), four.end());
      return four;
    };
    EXPECT_EQ(sorted(tissue.cells[c].corners, 4), sorted(expected.cells[c].corners, 4));
    EXPECT_EQ(sorted(tissue.cells[c].corners, 0), sorted(expected.cells[c].corners, 0));
  }
  for (const Facet& facet : tissue.apical_facets) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = tissue.rest_positions[facet.nodes[i].index()];
    EXPECT_GT(facet_area_vector(points).dot(points[0]), 0);
  }
  std::cout << tissue.cells.size() << " cells, " << tissue.apical_facets.size() << " facets\n";
}

TEST(TissueFromMesh, KeepsTheOrderOfTheNodesAndDropsUnusedOnes) {
  HexahedralMesh mesh = mesh_of(small_shell());
  mesh.points.insert(mesh.points.begin(), Vec3(std::nan(""), 0, 0));
  mesh.points.push_back(Vec3::Zero());
  for (auto& cell : mesh.cells)
    for (NodeId& node : cell) node = NodeId(node.number() + 1);
  const Tissue tissue = tissue_from_mesh(mesh, {1, 1, 1});
  EXPECT_EQ(tissue.rest_positions, small_shell().rest_positions);
  EXPECT_EQ(tissue.elements, small_shell().elements);
}

// Some or all cells with nodes of their own, at the same places up to rounding.
TEST(TissueFromMesh, MergesCoincidentNodes) {
  const Tissue expected = small_shell();
  for (const std::size_t step : {expected.cells.size(), std::size_t{3}, std::size_t{1}}) {
    HexahedralMesh mesh = mesh_of(expected);
    for (std::size_t cell = 0; cell < mesh.cells.size(); cell += step)
      for (NodeId& node : mesh.cells[cell]) {
        mesh.points.emplace_back(mesh.points[node.index()] * (1 + 1e-12));
        node = NodeId(mesh.points.size() - 1);
      }
    std::set<NodeId> used;
    for (const auto& cell : mesh.cells) used.insert(cell.begin(), cell.end());
    const Tissue tissue = tissue_from_mesh(mesh, {});
    EXPECT_EQ(tissue.node_count(), expected.node_count());
    EXPECT_EQ(tissue.apical_facets.size(), expected.apical_facets.size());
    EXPECT_NEAR(total_volume(tissue), total_volume(expected), 1e-10 * total_volume(expected));
    EXPECT_EQ(tissue.remarks, std::vector<std::string>{std::to_string(used.size() - expected.node_count()) +
                                                       " coincident nodes were merged"});
  }
}

TEST(TissueFromMesh, RefusesWhatDoesNotFit) {
  const HexahedralMesh good = mesh_of(small_shell());
  ASSERT_EQ(mesh_error(good), "");
  const auto expect_error = [&](const char* part, const auto& change) {
    HexahedralMesh mesh = good;
    change(mesh);
    EXPECT_SAYS(mesh_error(mesh), part) << mesh_error(mesh) << "; expected: " << part;
  };
  expect_error("coordinates must be finite", [](auto& m) { m.points[3].y() = std::nan(""); });
  expect_error("coordinates must be finite", [](auto& m) { m.points[3].y() = INFINITY; });
  expect_error("cell 7 uses node", [](auto& m) { m.cells[7][2] = NodeId(100'000); });
  expect_error("cell 7 uses node -1", [](auto& m) { m.cells[7][2] = NodeId(-1); });
  expect_error("apical faces are given", [](auto& m) { m.apical_faces = {5}; });
  expect_error("faces are 0 to 5", [](auto& m) { m.apical_faces.assign(m.cells.size(), 6); });
  expect_error("has 1 values for", [](auto& m) { m.arrays["short"] = {1}; });
  // A missing cell opens the shell: its surface is one.
  expect_error("a single surface", [](auto& m) { m.cells.erase(m.cells.begin() + 5); });
  // Corners of one cell at one place.
  expect_error("is inverted", [](auto& m) { m.points[m.cells[5][0].index()] = m.points[m.cells[5][1].index()]; });
}

TEST(MeshBytes, ComeBackAsTheMesh) {
  HexahedralMesh mesh = mesh_of(small_shell());
  mesh.apical_faces.assign(mesh.cells.size(), 5);
  mesh.arrays["a"] = CellArray(mesh.cells.size(), 1);
  mesh.arrays["b"] = CellArray(mesh.cells.size(), 0);
  mesh.arrays["b"][3] = 0.25;
  const std::string bytes = to_bytes(mesh);
  const HexahedralMesh back = from_bytes<HexahedralMesh>(bytes);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  EXPECT_EQ(back.apical_faces, mesh.apical_faces);
  EXPECT_EQ(back.arrays, mesh.arrays);
  EXPECT_THROW((void)from_bytes<HexahedralMesh>(std::string_view(bytes).substr(0, bytes.size() - 1)), MeshError);
  EXPECT_THROW((void)from_bytes<HexahedralMesh>({}), MeshError);
}

HexahedralMesh mesh_in_groups(const Tissue& tissue) {
  HexahedralMesh mesh;
  mesh.points = tissue.rest_positions;
  mesh.cells = tissue.elements;
  mesh.groups = groups_of(tissue);
  return mesh;
}

Tissue polygons(PolygonSplit split, int layers = 1) {
  return tissue_from_prisms(irregular_polygons(8, 7, 4, 10, 0.15, 1), split, layers);
}

TEST(GroupedMesh, ComesBackTheSame) {
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites})
    for (const int layers : {1, 3}) {
      const Tissue sheet = polygons(split, layers),
                   egg = build_egg({250, 120, 120, {}, {}}, 150, 1, {20, split, layers});
      for (const Tissue* tissue : {&sheet, &egg}) {
        expect_same_tissue(tissue_from_mesh(from_bytes<HexahedralMesh>(to_bytes(mesh_in_groups(*tissue))), {1, 1, 1}),
                           *tissue);
      }
    }
  for (const std::array<int, 3>& elements : {std::array{2, 2, 1}, {1, 2, 3}}) {
    const Tissue pill = build_shell({460, 280, 40, {6, 3, 4}, elements}),
                 block = build_block({60, 40, 20, {3, 2, 1}, elements});
    for (const Tissue* tissue : {&pill, &block}) {
      expect_same_tissue(tissue_from_mesh(mesh_in_groups(*tissue), {1, 1, 1}), *tissue);
    }
  }
  EXPECT_TRUE(groups_of(build_block({60, 40, 20, {3, 2, 1}, {1, 1, 1}})).is_empty());
}

// As others may write it: cells in another order than their hexahedra, these in any, upside down.
TEST(GroupedMesh, OfMixedOrder) {
  const Tissue tissue = polygons(PolygonSplit::kites);
  const HexahedralMesh mesh = mesh_in_groups(tissue);
  HexahedralMesh mixed = mesh;
  const std::size_t n = mesh.cells.size();
  mixed.arrays["gene"].resize(n);
  for (std::size_t e = 0; e < n; ++e) {
    const auto& [a, b, c, d, p, q, r, s] = mesh.cells[n - 1 - e];
    mixed.cells[e] = {q, p, s, r, b, a, d, c};
    mixed.groups.cell_of[e] = 10 + 2 * mesh.groups.cell_of[n - 1 - e];
    mixed.arrays["gene"][e] = mesh.groups.cell_of[n - 1 - e] + (e % 2 == 0 ? 0 : 0.5);
  }
  mixed.apical_faces.assign(n, 4);
  const Tissue back = tissue_from_mesh(mixed, {1, 1, 1});
  ASSERT_EQ(back.cells.size(), tissue.cells.size());
  for (std::size_t c = 0; c < back.cells.size(); ++c) {
    EXPECT_EQ(back.cells[c].corners, tissue.cells[c].corners);
    EXPECT_NEAR(cell_volume(back, back.cells[c], back.rest_positions),
                cell_volume(tissue, tissue.cells[c], tissue.rest_positions), 1e-9);
    EXPECT_NEAR(back.cell_arrays.at("gene")[c], static_cast<double>(c) + 0.25, 0.11);
  }
}

TEST(GroupedMesh, SaysWhatIsWrong) {
  const HexahedralMesh good = mesh_in_groups(polygons(PolygonSplit::diagonals));
  const auto expect = [&](const auto& spoil, const std::string& said) {
    HexahedralMesh mesh = good;
    spoil(mesh);
    expect_mesh_error([&] { tissue_from_mesh(mesh, {1, 1, 1}); }, said);
  };
  expect([](auto& m) { m.groups.cell_of.pop_back(); }, "cell_id has ");
  expect([](auto& m) { m.points.emplace_back(0, 0, 0); }, "belongs to no hexahedron; remove it");
  expect([](auto& m) { m.groups.corner_counts.pop_back(); }, "cell_corner_counts has 55 values for 56 cells");
  expect([](auto& m) { m.groups.corner_counts[0] = 5; }, "um has 5 corners; give 6 or more");
  expect([](auto& m) { m.groups.corner_counts[55] += 2; }, "cell 55 at (");
  expect([](auto& m) { m.groups.corners.push_back(0); }, "cell_corner_counts adds up to");
  expect([](auto& m) { m.groups.corners[0] = -1; }, "um is node -1, which is not free");
  expect([](auto& m) { m.groups.corners[0] = static_cast<int>(m.points.size()) - 1; }, "which is not free");
  expect([](auto& m) { std::swap(m.groups.corners[0], m.groups.corners[1]); }, "the corners of cell 0 at (");
  expect([](auto& m) { m.groups.hanging.pop_back(); }, "hanging_nodes must give, for each");
  expect([](auto& m) { m.groups.hanging[1] = 1 << 20; }, "which is not free");
  expect([](auto& m) { m.groups.hanging[1] = m.groups.hanging[4]; }, "does not lie in the middle between them");
  expect([](auto& m) { m.groups.elements_per_cell = {2, 2}; }, "elements_per_cell has 2 numbers for 56 cells");
  expect([](auto& m) { m.groups.elements_per_cell.assign(3 * 56, 1); }, "hexahedra; elements_per_cell is 1 x 1 x 1");
  expect_mesh_error([&] { tissue_from_mesh(good, {2, 2, 1}); }, "cells of this file already have several");
  HexahedralMesh grid = mesh_in_groups(build_block({60, 40, 20, {3, 2, 1}, {2, 2, 1}}));
  std::swap(grid.cells[0], grid.cells[1]);
  expect_mesh_error([&] { tissue_from_mesh(grid, {1, 1, 1}); }, "do not form a grid of 2 x 2 x 1");
}

using Case = std::pair<PolygonSplit, int>;  // split, layers

class Prisms : public testing::TestWithParam<Case> {
 protected:
  static Tissue of(const PrismSheet& sheet) {
    const auto [split, layers] = GetParam();
    return tissue_from_prisms(sheet, split, layers);
  }
  static bool hangs() { return GetParam().first == PolygonSplit::diagonals; }
};

INSTANTIATE_TEST_SUITE_P(Splits, Prisms,
                         testing::Values(Case{PolygonSplit::diagonals, 1}, Case{PolygonSplit::diagonals, 2},
                                         Case{PolygonSplit::kites, 1}, Case{PolygonSplit::kites, 3}),
                         [](const auto& given) {
                           return std::string(given.param.first == PolygonSplit::kites ? "kites" : "diagonals") +
                                  std::to_string(given.param.second);
                         });

double flat_area(const PrismSheet& sheet, std::size_t cell) {
  const auto& polygon = sheet.cells[cell];
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += sheet.apical[polygon[i]].cross(sheet.apical[polygon[(i + 1) % polygon.size()]]).z();
  return twice / 2;
}

TEST_P(Prisms, FillTheirPolygons) {
  const PrismSheet sheet = irregular_polygons(9, 8, 4, 12, 0.1, 3);
  const Tissue tissue = of(sheet);
  ASSERT_EQ(tissue.cells.size(), sheet.cells.size());
  std::map<std::size_t, int> of_sides;
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    ++of_sides[cell.sides()];
    const double area = flat_area(sheet, c);
    EXPECT_GT(area, 0);
    EXPECT_NEAR(areas[c], area, 1e-9 * area);
    EXPECT_NEAR(cell_volume(tissue, cell, tissue.rest_positions), 12 * area, 1e-9 * area);
    ASSERT_EQ(cell.sides(), sheet.cells[c].size());
    for (std::size_t i = 0; i < cell.sides(); ++i) {
      EXPECT_EQ(tissue.rest_positions[cell.apical_corners()[i].index()], sheet.apical[sheet.cells[c][i]]);
      EXPECT_EQ(tissue.rest_positions[cell.basal_corners()[i].index()], sheet.basal[sheet.cells[c][i]]);
      EXPECT_LT(cell.corners[i].index(), tissue.free_node_count()) << "corners are free";
    }
    EXPECT_EQ(cell.edges.size(), 3 * cell.sides());
  }
  for (const std::size_t sides : {5, 6, 7}) EXPECT_GT(of_sides[sides], 0) << sides;
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.1);
}

TEST_P(Prisms, HaveTheirWallsInCommon) {
  const Tissue tissue = of(bent(irregular_polygons(9, 8, 4, 12, 0.1, 3), [](const Vec3& x) {
    const double angle = x.x() / 60, radius = 60 + x.z();
    return Vec3(radius * std::sin(angle), x.y(), radius * std::cos(angle) + 3 * std::sin(x.y() / 20));
  }));
  expect_faces_enclose_the_cells(tissue);
  std::set<NodeId> used;
  for (const auto& element : tissue.elements) used.insert(element.begin(), element.end());
  EXPECT_EQ(used.size(), tissue.node_count());
  EXPECT_EQ(!tissue.hanging.empty(), hangs());
  for (std::size_t h = 0; h < tissue.hanging.size(); ++h) {
    double sum = 0;
    for (const auto& [node, weight] : tissue.hanging[h]) {
      EXPECT_LT(node.index(), tissue.free_node_count());
      sum += weight;
    }
    EXPECT_EQ(sum, 1);
    EXPECT_LE((mean_of(tissue.hanging[h], tissue.rest_positions) - tissue.rest_positions[tissue.free_node_count() + h])
                  .norm(),
              1e-12);
  }
}

TEST_P(Prisms, TakeTrianglesToo) {
  PrismSheet sheet;
  sheet.apical = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, 0}, {16, 5, 0}};
  for (const Vec3& x : sheet.apical) sheet.basal.push_back(x - 8 * Vec3::UnitZ());
  sheet.cells = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2}};
  const Tissue tissue = of(sheet);
  for (const Cell& cell : tissue.cells)
    EXPECT_NEAR(cell_volume(tissue, cell, tissue.rest_positions), 8 * (&cell == &tissue.cells[4] ? 30 : 25), 1e-9);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.1);
  expect_faces_enclose_the_cells(tissue);
}

TEST_P(Prisms, EdgesAreChainsThatKnowTheirDirection) {
  const Tissue tissue = of(honeycomb(4, 4, 5, 10));
  const auto [split, layers] = GetParam();
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side == CellSide::lateral) {
        EXPECT_EQ(edge.direction, EdgeDirection::lateral);
        EXPECT_EQ(edge.nodes.size(), static_cast<std::size_t>(layers) + 1);
        EXPECT_GT(tissue.rest_positions[edge.nodes.back().index()].z(),
                  tissue.rest_positions[edge.nodes.front().index()].z());
        continue;
      }
      EXPECT_EQ(edge.nodes.size(), split == PolygonSplit::kites ? 3u : 2u);
      // Hexagons stand on a corner: two edges run across, four at 30 degrees to x.
      if (edge.direction == EdgeDirection::across)
        EXPECT_NEAR(edge.along, 0, 1e-12);
      else
        EXPECT_NEAR(edge.along, 0.75, 1e-12);
    }
}

TEST(Prisms, OfFourCornersAreAsAGridMakesThem) {
  PrismSheet sheet;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i)
      sheet.apical.emplace_back(10 * i, 8 * j, 0), sheet.basal.emplace_back(10 * i, 8 * j, -20);
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 3; ++i) sheet.cells.push_back({i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j});
  const Tissue prisms = tissue_from_prisms(sheet, PolygonSplit::diagonals, 1);
  const Tissue block = build_block({.length_um = 30, .width_um = 16, .cell_height_um = 20, .cells = {3, 2, 1}});
  ASSERT_EQ(prisms.elements.size(), block.elements.size());
  EXPECT_TRUE(prisms.hanging.empty());
  for (std::size_t e = 0; e < prisms.elements.size(); ++e)
    EXPECT_NEAR(hex_volume(prisms.element_rest_shape[e]), hex_volume(block.element_rest_shape[e]), 1e-9);
}

}  // namespace
