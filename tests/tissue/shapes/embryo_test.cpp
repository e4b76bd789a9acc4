// Embryos of the paper's grid, blocks and slices.
#include "tissue/shapes/embryo.hpp"

#include "support/testing.hpp"
#include "tissue/mesh_quality.hpp"

namespace {

const ShellShape pill{};  // the defaults are the paper's Drosophila
const ShellShape sphere{.length_um = 280, .cells = {9, 9, 8}};

ShellShape refined(ShellShape shape, std::array<int, 3> elements) {
  shape.elements_per_cell = elements;
  return shape;
}

/// Nodes a layer of the surface grid of an a x b x c box: Euler's V = F + 2 for a closed surface of quadrilaterals.
std::size_t nodes_a_layer(int a, int b, int c) { return 2 * static_cast<std::size_t>(a * b + b * c + c * a) + 2; }

TEST(Embryo, CountsFollowTheGridForOtherShapesAndRefinements) {
  for (const std::array<int, 3>& cells : {std::array<int, 3>{4, 3, 2}, {10, 5, 6}, {1, 1, 1}, {12, 7, 4}})
    for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 1, 3}, {3, 2, 1}}) {
      const Tissue tissue = build_shell({.cells = cells, .elements_per_cell = elements});
      const auto [a, b, c] = cells;
      const auto [along, across, layers] = elements;
      const std::size_t squares = nodes_a_layer(a, b, c) - 2;
      const std::size_t fine = nodes_a_layer(a * along, b * across, c * across);
      EXPECT_EQ(tissue.cells.size(), squares);
      EXPECT_EQ(tissue.node_count(), fine * (layers + 1));
      EXPECT_EQ(tissue.elements.size(), (fine - 2) * layers);
      EXPECT_EQ(tissue.apical_facets.size(), fine - 2);
      EXPECT_EQ(tissue.basal_facets.size(), fine - 2);
      EXPECT_EQ(tissue.element_cell.size(), tissue.elements.size());
      EXPECT_EQ(tissue.regions.at("all"), CellSet(squares, true));
    }
}

TEST(Embryo, NodesOfCutCellsAreNumberedAsElementsCome) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{2, 1, 1}, {2, 2, 3}}) {
    const Tissue tissue = build_shell(refined(pill, elements));
    std::size_t next = 0;
    for (const auto& element : tissue.elements)
      for (const NodeId node : element) {
        ASSERT_LE(node.index(), next);
        if (node.index() == next) ++next;
      }
    EXPECT_EQ(next, tissue.node_count());
  }
}

TEST(Embryo, NodesOfWholeCellsAreNumberedLayerByLayer) {
  const Tissue tissue = build_shell(pill);
  const std::size_t nodes_a_layer = tissue.node_count() / 2;
  for (const auto& element : tissue.elements)
    for (int i = 0; i < 4; ++i) {
      EXPECT_LT(element[i].index(), nodes_a_layer);
      EXPECT_EQ(element[i + 4].index(), element[i].index() + nodes_a_layer);
    }
}

TEST(Embryo, PositionsAreSymmetricAboutThreePlanesToTheBit) {
  for (const ShellShape& shape : {pill, sphere, refined(pill, {2, 2, 1}), refined(sphere, {1, 3, 2})}) {
    const Tissue tissue = build_shell(shape);
    std::set<std::array<double, 3>> positions;
    for (const Vec3& x : tissue.rest_positions) positions.insert({x.x() + 0.0, x.y() + 0.0, x.z() + 0.0});
    EXPECT_EQ(positions.size(), tissue.node_count()) << "two nodes in one place";
    for (const auto& [x, y, z] : positions) {
      EXPECT_TRUE(positions.count({-x + 0.0, y, z}));
      EXPECT_TRUE(positions.count({x, -y + 0.0, z}));
      EXPECT_TRUE(positions.count({x, y, -z + 0.0}));
    }
  }
}

TEST(Embryo, ElementsAreUprightAndApicalFacesLookOutward) {
  for (const ShellShape& shape : {pill, sphere, refined(pill, {2, 2, 2})}) {
    const Tissue tissue = build_shell(shape);
    for (const auto& element : tissue.elements) {
      const HexPoints points = gather(tissue.rest_positions, element);
      for (const Vec3& corner : hex_reference_nodes) EXPECT_GT(hex_jacobian(points, corner).determinant(), 0);
    }
    const auto check = [&](const std::vector<Facet>& facets, double side) {
      for (const Facet& facet : facets) {
        std::array<Vec3, 4> points;
        Vec3 centre = Vec3::Zero();
        for (int i = 0; i < 4; ++i) {
          points[i] = tissue.rest_positions[facet.nodes[i].index()];
          centre += points[i] / 4;
        }
        const Vec3 from_cell = centre - cell_centre(tissue.cells[facet.cell.index()], tissue.rest_positions);
        EXPECT_GT(facet_area_vector(points).dot(from_cell), 0) << "counter-clockwise from outside the cell";
        EXPECT_GT(side * from_cell.dot(centre), 0);
      }
    };
    check(tissue.apical_facets, 1);
    check(tissue.basal_facets, -1);
    for (const Cell& cell : tissue.cells)
      for (int i = 0; i < 4; ++i)
        EXPECT_GT(tissue.rest_positions[cell.corners[i + 4].index()].norm(),
                  tissue.rest_positions[cell.corners[i].index()].norm());
  }
}

// The cells share out the volume between the two smooth surfaces, less what their flat facets cut off: 16 840 um^3 a
// cell on the pill (about 16 700 with facets, as in the paper's reading), 16 230 on the sphere.
TEST(Embryo, CellsAreEven) {
  for (const auto& [shape, name] : {std::pair{pill, "pill"}, std::pair{sphere, "sphere"}}) {
    const Tissue tissue = build_shell(shape);
    const Spread volume = mesh_quality(tissue, tissue.rest_positions).volume_um3;
    std::printf("%s: cell volumes %.0f to %.0f um^3, mean %.0f, spread %.3f\n", name, volume.min, volume.max,
                volume.mean, volume.max / volume.min);
    const double pi = std::numbers::pi, cylinder = shape.length_um - shape.diameter_um;
    const double smooth =
        4 * pi / 3 * (std::pow(140.0, 3) - std::pow(100.0, 3)) + pi * (140 * 140 - 100 * 100) * cylinder;
    const double share = volume.mean * static_cast<double>(tissue.cells.size()) / smooth;
    EXPECT_LT(share, 1);
    EXPECT_GT(share, 0.98);
    EXPECT_LE(volume.max / volume.min, 1.1);
  }
  const Tissue tissue = build_shell(pill);
  EXPECT_NEAR(mesh_quality(tissue, tissue.rest_positions).volume_um3.mean, 16700, 100);
}

ShellShape scaled(double k, std::array<int, 3> cells) {
  return {.length_um = 460 * k, .diameter_um = 280 * k, .cells = cells};
}

// The figures of the project hang on this mesh.
TEST(Embryo, ThePapersPillStaysWhereItIs) {
  const Vectors& x = build_shell(pill).rest_positions;
  const std::vector<std::pair<std::size_t, Vec3>> known = {
      {0, {-147.819000552090, -60.305776682224, -54.956132268484}},
      {100, {-77.655578046345, 8.899125137128, -99.603240769534}},
      {333, {-158.708664721198, 71.176449862637, -14.595628701140}},
      {700, {160.522618543185, 21.531988769583, 67.549490993190}},
      {758, {-170.946600772926, -84.428087355113, -76.938585175878}},
      {1200, {-164.898082593785, 116.379352042072, 21.121639189276}},
      {1515, {170.946600772926, 84.428087355113, 76.938585175878}},
  };
  for (const auto& [node, place] : known) EXPECT_LE((x[node] - place).norm(), 1e-10) << node;
}

// In proportion and not: between the coarse grids that the large ones begin with, too.
TEST(Embryo, LargeOnesAreAsEvenAsThePapers) {
  for (const ShellShape& shape :
       {scaled(2, {36, 18, 16}), scaled(3, {54, 27, 24}), scaled(5, {90, 45, 40}), scaled(8, {144, 72, 64}),
        scaled(5.1, {92, 46, 42}), scaled(2.25, {41, 20, 18}), scaled(5.5, {100, 50, 44}),
        ShellShape{.length_um = 2800, .diameter_um = 2800, .cells = {90, 90, 80}},
        ShellShape{.length_um = 4600, .diameter_um = 600, .cells = {200, 20, 18}}}) {
    const Tissue tissue = build_shell(shape);
    const MeshQuality quality = mesh_quality(tissue, tissue.rest_positions);
    const double spread = quality.volume_um3.max / quality.volume_um3.min;
    std::printf("%d x %d x %d: spread of volumes %.3f, worst scaled Jacobian %.3f\n", shape.cells[0], shape.cells[1],
                shape.cells[2], spread, quality.min_scaled_jacobian);
    EXPECT_LE(spread, 1.086);  // the paper's pill
    EXPECT_GE(quality.min_scaled_jacobian, 0.83);
    const bool in_proportion = shape.cells[0] == 2 * shape.cells[1] && shape.cells[1] * 8 == shape.cells[2] * 9;
    if (in_proportion) {
      EXPECT_GE(quality.min_scaled_jacobian, 0.856);
    }
  }
}

TEST(Embryo, GridsOutOfAllProportionDoNotFold) {
  for (const ShellShape& shape :
       {scaled(3, {60, 60, 4}), scaled(1, {40, 80, 10}), scaled(1, {5, 5, 200}), scaled(1, {100, 10, 10}),
        scaled(1, {31, 3, 40}), ShellShape{.length_um = 12000, .diameter_um = 120, .cells = {600, 4, 4}}}) {
    const Tissue tissue = build_shell(shape);
    EXPECT_GT(mesh_quality(tissue, tissue.rest_positions).min_scaled_jacobian, 0) << shape.cells[0];
  }
}

TEST(Embryo, NodesLieOnTheSurfacesOfTheirLayers) {
  for (const ShellShape& shape : {pill, sphere, refined(pill, {2, 3, 2}), refined(sphere, {3, 3, 4})}) {
    const Tissue tissue = build_shell(shape);
    ASSERT_TRUE(tissue.outer_shape.has_value());
    const double half_axis = (shape.length_um - shape.diameter_um) / 2;
    EXPECT_EQ(tissue.outer_shape->capsule()->half_axis_um, half_axis);
    EXPECT_EQ(tissue.outer_shape->capsule()->radius_um, 140);
    const int layers = shape.elements_per_cell[2];
    std::map<long, int> counts;
    for (const Vec3& x : tissue.rest_positions) {
      const double radius = (x - Vec3(std::clamp(x.x(), -half_axis, half_axis), 0, 0)).norm();
      const double layer = (radius - 100) / (40.0 / layers);
      EXPECT_NEAR(layer, std::round(layer), 1e-10);
      ++counts[std::lround(layer)];
    }
    EXPECT_EQ(counts.size(), static_cast<std::size_t>(layers + 1));
    for (const auto& [layer, count] : counts) EXPECT_EQ(count * (layers + 1), static_cast<int>(tissue.node_count()));
  }
}

TEST(Embryo, CornersOfCellsDoNotDependOnTheRefinement) {
  const Tissue coarse = build_shell(pill);
  for (const std::array<int, 3>& elements : {std::array<int, 3>{2, 2, 2}, {1, 3, 1}, {2, 1, 1}}) {
    const Tissue fine = build_shell(refined(pill, elements));
    ASSERT_EQ(coarse.cells.size(), fine.cells.size());
    for (std::size_t c = 0; c < coarse.cells.size(); ++c)
      for (int i = 0; i < 8; ++i)
        EXPECT_LE((coarse.rest_positions[coarse.cells[c].corners[i].index()] -
                   fine.rest_positions[fine.cells[c].corners[i].index()])
                      .norm(),
                  1e-11);
  }
}

TEST(Embryo, EdgesOfCellsRunAlongAcrossAndUp) {
  const Tissue tissue = build_shell(refined(pill, {2, 3, 2}));
  for (const Cell& cell : tissue.cells)
    for (int e = 0; e < 12; ++e) {
      const CellEdge& edge = cell.edges[e];
      EXPECT_EQ(edge.nodes.front(), cell.corners[hex_edges[e][0]]);
      EXPECT_EQ(edge.nodes.back(), cell.corners[hex_edges[e][1]]);
      EXPECT_EQ(edge.side == CellSide::lateral, edge.direction == EdgeDirection::lateral);
      EXPECT_EQ(edge.side, e >= 8 ? CellSide::lateral : e % 4 < 2 ? CellSide::basal : CellSide::apical);
      if (edge.side == CellSide::lateral) {
        EXPECT_EQ(edge.nodes.size(), 3u);
      }
    }
  // On the ventral face of the cylinder `along` is x.
  int along = 0;
  for (const Cell& cell : tissue.cells) {
    if (cell.grid_place->face != GridPlace::Face::ventral) continue;
    for (const CellEdge& edge : cell.edges) {
      const Vec3 d =
          tissue.rest_positions[edge.nodes.back().index()] - tissue.rest_positions[edge.nodes.front().index()];
      if (std::abs(cell_centre(cell, tissue.rest_positions).x()) > 60 || edge.side == CellSide::lateral) continue;
      EXPECT_EQ(edge.direction == EdgeDirection::along, std::abs(d.x()) > 0.8 * d.norm());
      EXPECT_EQ(edge.nodes.size(), edge.direction == EdgeDirection::along ? 3u : 4u);
      along += edge.direction == EdgeDirection::along;
    }
  }
  EXPECT_GT(along, 100);
}

TEST(Embryo, NeighboursShareTheirNodes) {
  for (const ShellShape& shape : {pill, refined(sphere, {2, 2, 2})}) {
    const Tissue tissue = build_shell(shape);
    std::map<std::set<int>, int> faces;
    for (const auto& element : tissue.elements)
      for (const auto& face : hex_faces) {
        std::set<int> nodes;
        for (const int i : face) nodes.insert(element[i].number());
        ASSERT_EQ(nodes.size(), 4u);
        ++faces[nodes];
      }
    std::size_t outside = 0;
    for (const auto& [nodes, count] : faces) {
      EXPECT_LE(count, 2);
      outside += count == 1;
    }
    EXPECT_EQ(outside, tissue.apical_facets.size() + tissue.basal_facets.size()) << "a closed sheet has no edge";
  }
}

TEST(Embryo, VentralFaceLiesBelowAndItsCellsAreInPlace) {
  const Tissue tissue = build_shell(pill);
  std::set<std::array<int, 2>> places;
  for (const Cell& cell : tissue.cells) {
    const Vec3 centre = cell_centre(cell, tissue.rest_positions);
    const GridPlace& place = *cell.grid_place;
    if (place.face != GridPlace::Face::ventral) continue;
    EXPECT_EQ(place.count, (std::array<int, 2>{18, 9}));
    EXPECT_LT(centre.z(), 0);
    EXPECT_EQ(centre.x() > 0, place.place[0] >= 9) << "columns run to the posterior";
    if (place.place[1] == 4) {
      EXPECT_NEAR(centre.y(), 0, 1e-12);
    } else {
      EXPECT_EQ(centre.y() > 0, place.place[1] > 4) << "rows run to the right";
    }
    places.insert(place.place);
  }
  EXPECT_EQ(places.size(), 18u * 9u);
}

TEST(Embryo, BlockIsARegularBoxWithItsApexOnTop) {
  const Tissue block = build_block(
      {.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 2}, .elements_per_cell = {2, 1, 3}});
  EXPECT_EQ(block.cells.size(), 12u);
  EXPECT_EQ(block.elements.size(), 72u);
  EXPECT_EQ(block.node_count(), 7u * 3 * 7);
  EXPECT_FALSE(block.outer_shape.has_value());
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (const Vec3& x : block.rest_positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  EXPECT_EQ(low, Vec3(-30, -20, -30));
  EXPECT_EQ(high, Vec3(30, 20, 30));
  for (const Cell& cell : block.cells) EXPECT_NEAR(cell_volume(block, cell, block.rest_positions), 20 * 20 * 30, 1e-9);
  EXPECT_EQ(block.apical_facets.size(), 6u * 2);
  for (const Facet& facet : block.apical_facets)
    for (const NodeId node : facet.nodes) EXPECT_EQ(block.rest_positions[node.index()].z(), 30);
  for (const Facet& facet : block.basal_facets)
    for (const NodeId node : facet.nodes) EXPECT_EQ(block.rest_positions[node.index()].z(), -30);
}

TEST(Slice, IsARingOfEqualCellsWithABelly) {
  const Tissue tissue = build_slice({14, 180, 35, {2, 6, 4}, {1, 2, 2}});
  EXPECT_EQ(tissue.cells.size(), 2u * 20);
  EXPECT_EQ(tissue.elements.size(), 4u * 40);
  EXPECT_EQ(tissue.apical_facets.size(), 2u * 40);
  const auto volume_of = [&](const Cell& cell) { return cell_volume(tissue, cell, tissue.rest_positions); };
  std::map<GridPlace::Face, int> counts;
  for (const Cell& cell : tissue.cells) {
    EXPECT_NEAR(volume_of(cell) / volume_of(tissue.cells[0]), 1, 1e-12);
    const Vec3 centre = cell_centre(cell, tissue.rest_positions);
    const double angle = std::atan2(centre.y(), -centre.z());  // from the belly towards the right
    using enum GridPlace::Face;
    const auto face = cell.grid_place->face;
    ++counts[face];
    if (face == ventral) {
      EXPECT_LT(std::abs(angle), M_PI * 6 / 20);
    }
    if (face == dorsal) {
      EXPECT_GT(std::abs(angle), M_PI * 14 / 20);
    }
    if (face == right) {
      EXPECT_GT(angle, 0);
    }
    if (face == left) {
      EXPECT_LT(angle, 0);
    }
  }
  EXPECT_EQ(counts[GridPlace::Face::ventral], 12);
  EXPECT_EQ(counts[GridPlace::Face::left], 8);
  // Symmetric to the bit.
  std::set<std::array<double, 3>> places;
  for (const Vec3& x : tissue.rest_positions) places.insert({x.x(), x.y() + 0.0, x.z()});
  for (const Vec3& x : tissue.rest_positions)
    EXPECT_TRUE(places.contains({x.x(), 0.0 - x.y(), x.z()})) << x.transpose();
}

Vec3 point(const SurfaceGrid::Place& place) { return {1.0 * place[0], 1.0 * place[1], 1.0 * place[2]}; }

TEST(SurfaceGrid, FacesHaveTheirPlacesAndSides) {
  using Face = GridPlace::Face;
  const SurfaceGrid grid({4, 3, 2});
  std::map<Face, std::set<std::array<int, 2>>> places;
  std::map<Face, std::array<int, 2>> counts;
  const std::map<Face, Vec3> outward = {{Face::ventral, -Vec3::UnitZ()},  {Face::dorsal, Vec3::UnitZ()},
                                        {Face::left, -Vec3::UnitY()},     {Face::right, Vec3::UnitY()},
                                        {Face::anterior, -Vec3::UnitX()}, {Face::posterior, Vec3::UnitX()}};
  for (const SurfaceGrid::Square& square : grid.squares()) {
    const GridPlace& place = square.grid_place;
    EXPECT_EQ(point(square.u).cross(point(square.v)), outward.at(place.face));
    EXPECT_TRUE(places[place.face].insert(place.place).second);
    counts[place.face] = place.count;
    for (int i = 0; i < 2; ++i) {
      EXPECT_GE(place.place[i], 0);
      EXPECT_LT(place.place[i], place.count[i]);
    }
  }
  EXPECT_EQ(counts[Face::ventral], (std::array<int, 2>{4, 3}));
  EXPECT_EQ(counts[Face::dorsal], (std::array<int, 2>{4, 3}));
  EXPECT_EQ(counts[Face::anterior], (std::array<int, 2>{3, 2}));
  EXPECT_EQ(counts[Face::posterior], (std::array<int, 2>{3, 2}));
  EXPECT_EQ(counts[Face::left][0], 4);
  EXPECT_EQ(counts[Face::right][0], 4);
  EXPECT_EQ(places.size(), 6u);
}

}  // namespace
