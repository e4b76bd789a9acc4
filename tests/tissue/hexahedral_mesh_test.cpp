#include "tissue/hexahedral_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <set>

#include "tissue/files/child_reading.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

HexahedralMesh mesh_of(const Tissue& tissue) { return {tissue.rest_positions, tissue.elements, {}, {}}; }

std::string mesh_error(const HexahedralMesh& mesh) {
  try {
    (void)tissue_from_mesh(mesh, {1, 1, 1});
  } catch (const MeshError& error) {
    return error.what();
  }
  return {};
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
  int cases = 0;
  const auto expect_error = [&](const char* part, const auto& change) {
    HexahedralMesh mesh = good;
    change(mesh);
    EXPECT_NE(mesh_error(mesh).find(part), std::string::npos) << mesh_error(mesh) << "; expected: " << part;
    ++cases;
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
  std::cout << cases << " cases\n";
}

TEST(MeshBytes, ComeBackAsTheMesh) {
  HexahedralMesh mesh = mesh_of(small_shell());
  mesh.apical_faces.assign(mesh.cells.size(), 5);
  mesh.arrays["a"] = CellArray(mesh.cells.size(), 1);
  mesh.arrays["b"] = CellArray(mesh.cells.size(), 0);
  mesh.arrays["b"][3] = 0.25;
  const std::string bytes = mesh_to_bytes(mesh);
  const HexahedralMesh back = mesh_from_bytes(bytes);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  EXPECT_EQ(back.apical_faces, mesh.apical_faces);
  EXPECT_EQ(back.arrays, mesh.arrays);
  EXPECT_THROW((void)mesh_from_bytes(std::string_view(bytes).substr(0, bytes.size() - 1)), MeshError);
  EXPECT_THROW((void)mesh_from_bytes({}), MeshError);
}

}  // namespace
}  // namespace plica
