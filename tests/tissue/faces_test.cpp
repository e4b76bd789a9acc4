// Parts of a tissue: faces, lines of its lattice, rows of cells, one side of its mirror planes.
#include "tissue/faces.hpp"

#include "support/prisms.hpp"
#include "support/whole.hpp"
#include "tissue/lattice.hpp"
#include "tissue/mirror.hpp"
#include "tissue/shapes/embryo.hpp"
#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace {

TEST(Faces, OfABlockAreItsWalls) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}});
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_EQ(counted.lateral, 3u * 3 + 4 * 2);  // walls along, walls across
  EXPECT_EQ(counted.rims, 2u * (3 + 2));
}

TEST(Faces, OfCellsOfSeveralElementsAreTheirElements) {
  const Tissue tissue = build_block(
      {.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}, .elements_per_cell = {2, 1, 2}});
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_EQ(counted.lateral, (3u * 3 * 2 + 4 * 2) * 2);
}

TEST(Faces, OfAnEmbryoHaveTwoCellsEach) {
  const Counted counted = expect_faces_enclose_the_cells(build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}}));
  EXPECT_EQ(counted.rims, 0u);
  EXPECT_EQ(counted.lateral, 2u * 128);  // four sides a cell, two cells a side
}

TEST(Faces, AtTheSidesBeginAtTheBase) {
  const Tissue block = build_block(
      {.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}, .elements_per_cell = {2, 1, 2}});
  for (const Tissue& tissue : {block, build_sheet({40, 40}, 12, 1, {10, PolygonSplit::diagonals, 1})}) {
    const std::vector<Face> faces = faces_of(tissue, CellSide::lateral);
    EXPECT_GT(faces.size(), 30U);
    for (const auto& [nodes, cell, beyond, share] : faces) {
      const auto z = [&](int corner) { return tissue.rest_positions[nodes[corner].index()].z(); };
      EXPECT_EQ(z(0), z(1));
      EXPECT_EQ(z(2), z(3));
      EXPECT_LT(z(0), z(2));
    }
  }
}

// One wall may face two daughters: it is two faces then.
TEST(Faces, FollowDivisions) {
  Tissue tissue = build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}});
  Random random(3);
  Counted before = expect_faces_enclose_the_cells(tissue);
  for (int round = 0; round < 3; ++round) {
    divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), 0);
    const Counted counted = expect_faces_enclose_the_cells(tissue);
    EXPECT_GT(counted.lateral, before.lateral);
    EXPECT_NEAR(counted.rim_area, before.rim_area, 1e-9 * before.rim_area);  // a wall inside has a cell on both sides
    before = counted;
  }
}

TEST(Faces, RimOfAClosedSurfaceIsEmptyWhereNodesHang) {
  Tissue shell = build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}});
  Random random(3);
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(rim_of(shell, shell.apical_facets).empty());
    divide(shell, cuts_of(random_divisions(shell, 0.5, random)), 0);
  }
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites}) {
    const Tissue egg = build_egg({250, 120, 120, 11, 5}, 300, 1, {20, split, 1});
    EXPECT_TRUE(rim_of(egg, egg.basal_facets).empty());
    EXPECT_FALSE(rim_of(egg, std::span(egg.basal_facets).subspan(1)).empty());
  }
}

// A block's, once about it and outward: what a division adds to it does not change what it goes round.
TEST(Faces, RimOfAnOpenSurfaceGoesRoundIt) {
  Tissue tissue = build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}});
  Random random(3);
  for (int round = 0; round < 3; ++round) {
    const auto rim = rim_of(tissue, tissue.apical_facets);
    EXPECT_GE(rim.size(), 2U * (4 + 3));
    double twice_area = 0;
    for (const auto& [from, to] : rim)
      twice_area += tissue.rest_positions[from.index()].cross(tissue.rest_positions[to.index()]).z();
    EXPECT_NEAR(twice_area, 2 * 80 * 60, 1e-9);
    divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), 0);
  }
}

using Segment = std::pair<NodeId, NodeId>;
using Place = std::pair<CellSide, EdgeDirection>;

const ShellShape refined{.cells = {6, 5, 4}, .elements_per_cell = {3, 2, 2}};

void add_segments(const std::vector<NodeId>& chain, std::multiset<Segment>& segments) {
  for (std::size_t s = 1; s < chain.size(); ++s) segments.insert(std::minmax(chain[s - 1], chain[s]));
}

TEST(Lattice, SharesOfTheLinesOfASideAndDirectionAddUpToTwo) {
  const Tissue tissue = build_shell(refined);
  for (const Cell& cell : tissue.cells) {
    std::map<Place, double> sums;
    std::map<Place, std::size_t> lines, segments;
    for (const CellLine& line : cell.lines) {
      const Place place{line.chain.side, line.chain.direction};
      sums[place] += line.share;
      ++lines[place];
      segments[place] = line.chain.nodes.size() - 1;
    }
    ASSERT_EQ(sums.size(), 5u);  // two directions on two sides, and the lateral edges
    for (const CellSide side : {CellSide::basal, CellSide::apical})
      for (const EdgeDirection direction : {EdgeDirection::along, EdgeDirection::across}) {
        const EdgeDirection other = direction == EdgeDirection::along ? EdgeDirection::across : EdgeDirection::along;
        EXPECT_NEAR(sums.at({side, direction}), 2, 1e-15);
        EXPECT_EQ((lines.at({side, direction})), (segments.at({side, other})) + 1);
      }
    EXPECT_EQ((sums.at({CellSide::lateral, EdgeDirection::lateral})), 4);
    EXPECT_EQ((lines.at({CellSide::lateral, EdgeDirection::lateral})), 4u);
    EXPECT_EQ((segments.at({CellSide::lateral, EdgeDirection::lateral})), 2u);
  }
}

// Half a share on the rim: together with the neighbour's line in the same place it is as strong as the ones within.
TEST(Lattice, LinesOnTheRimAreTheCellsEdgesAndHaveHalfAShare) {
  const Tissue tissue = build_shell(refined);
  int on_rim = 0, within = 0;
  for (const Cell& cell : tissue.cells) {
    std::map<Place, double> least, most;
    for (const CellLine& line : cell.lines) {
      const Place place{line.chain.side, line.chain.direction};
      least[place] = least.count(place) ? std::min(least[place], line.share) : line.share;
      most[place] = std::max(most[place], line.share);
    }
    for (const CellLine& line : cell.lines) {
      if (line.chain.side == CellSide::lateral) continue;
      bool is_edge = false;
      for (const CellEdge& edge : cell.edges)
        is_edge = is_edge || (edge.nodes == line.chain.nodes && edge.side == line.chain.side &&
                              edge.direction == line.chain.direction);
      const Place place{line.chain.side, line.chain.direction};
      EXPECT_DOUBLE_EQ(most[place], 2 * least[place]);
      EXPECT_EQ(line.share, is_edge ? least[place] : most[place]);
      ++(is_edge ? on_rim : within);
    }
  }
  EXPECT_EQ(on_rim, 8 * static_cast<int>(tissue.cells.size()));
  EXPECT_GT(within, 0);
}

TEST(Lattice, LinesAreTheElementEdgesOfTheFaceEachOnce) {
  const Tissue tissue = build_shell(refined);
  std::vector<std::set<Segment>> expected(tissue.cells.size());
  for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (const Facet& facet : *facets)
      for (int i = 0; i < 4; ++i)
        expected[facet.cell.index()].insert(std::minmax(facet.nodes[i], facet.nodes[(i + 1) % 4]));
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    std::multiset<Segment> found;
    for (const CellLine& line : tissue.cells[c].lines)
      if (line.chain.side != CellSide::lateral) add_segments(line.chain.nodes, found);
    EXPECT_EQ(found, std::multiset<Segment>(expected[c].begin(), expected[c].end())) << "cell " << c;
  }
}

TEST(Lattice, WithOneElementACellTheLinesAreExactlyTheEdges) {
  for (const Tissue& tissue : {build_shell({.cells = {6, 5, 4}}), build_block({.cells = {3, 2, 1}})})
    for (const Cell& cell : tissue.cells) {
      using Line = std::tuple<std::vector<NodeId>, CellSide, EdgeDirection>;
      std::set<Line> edges, lines;
      for (const CellEdge& edge : cell.edges) edges.insert({edge.nodes, edge.side, edge.direction});
      for (const auto& [line, share] : cell.lines) {
        lines.insert({line.nodes, line.side, line.direction});
        EXPECT_EQ(share, 1);
      }
      EXPECT_EQ(cell.lines.size(), 12u);
      EXPECT_EQ(lines, edges);
    }
}

// Seven columns, and an odd or an even number of rows across: a cell lies on the midline, or none does.
TEST(Rows, OfABlockAreItsRows) {
  for (const int across : {5, 6}) {
    const Tissue block = build_block({.length_um = 140, .width_um = 60, .cell_height_um = 40, .cells = {7, across, 1}});
    const std::vector<int> found = half_cells_from_midline(block);
    for (int c = 0; c < 7 * across; ++c) EXPECT_EQ(found[c], std::abs(2 * (c / 7) - (across - 1))) << c;
  }
}

// The belly's rows are those of its grid; its midline is not that of the back.
TEST(Rows, OfAPillAreThoseOfItsBelly) {
  const Tissue pill = build_shell({.length_um = 460, .cells = {18, 9, 8}});
  const std::vector<int> found = half_cells_from_midline(pill);
  int belly = 0;
  for (std::size_t c = 0; c < pill.cells.size(); ++c) {
    const GridPlace& place = *pill.cells[c].grid_place;
    // Half-way between the poles; nearer to them the shortest way leads over the end.
    if (place.face == GridPlace::Face::dorsal && place.place[0] == 9) {
      EXPECT_GE(found[c], 2 * 12);
    }
    if (place.face != GridPlace::Face::ventral) continue;
    EXPECT_EQ(found[c], std::abs(2 * place.place[1] - 8));
    ++belly;
  }
  EXPECT_EQ(belly, 162);
}

// Of polygons: every cell but those on the midline has a neighbour that is one cell nearer to it, and none that is
// nearer than that; on an egg a row is about a cell wide.
TEST(Rows, OfPolygonsAreCellsThatOnePasses) {
  const Tissue egg = build_egg({500, 180, 180, std::nullopt, std::nullopt}, 1500, 1, {});
  const std::vector<int> found = half_cells_from_midline(egg);
  const auto neighbours = wall_neighbours(egg);
  double width = 0, area = 0;
  int counted = 0;
  const std::vector<double> areas = face_areas(egg, CellSide::apical, egg.rest_positions);
  for (std::size_t c = 0; c < egg.cells.size(); ++c) {
    ASSERT_GE(found[c], 0);
    int nearest = found[c];
    for (const CellId other : neighbours[c]) nearest = std::min(nearest, found[other.index()]);
    if (found[c] > 0) {
      EXPECT_EQ(nearest, found[c] - 2);
    }
    Vec3 middle = Vec3::Zero();
    for (const NodeId node : egg.cells[c].apical_corners()) middle += egg.rest_positions[node.index()];
    middle /= static_cast<double>(egg.cells[c].sides());
    if (std::abs(middle.x()) > 50 || found[c] != 10) continue;
    width += std::abs(std::hypot(middle.y(), middle.z()) * std::atan2(middle.y(), -middle.z())) / 5;
    area += areas[c];
    ++counted;
  }
  ASSERT_GT(counted, 5);
  EXPECT_NEAR(width / counted, std::sqrt(area / counted), 0.1 * std::sqrt(area / counted));
}

TEST(Rows, RingsLieAroundASet) {
  const Tissue block = build_block({.length_um = 140, .width_um = 100, .cell_height_um = 40, .cells = {7, 5, 1}});
  CellSet one(35, false);
  one[17] = true;  // column 3, row 2
  for (const int rings : {1, 2}) {
    const CellSet around = cells_around(block, one, rings);
    for (int c = 0; c < 35; ++c) {
      const int walls = std::abs(c % 7 - 3) + std::abs(c / 7 - 2);
      EXPECT_EQ(around[c], walls > 0 && walls <= rings) << c;
    }
  }
  EXPECT_EQ(std::ranges::count(cells_around(block, CellSet(35, true), 3), true), 0);
}

TEST(Rows, NeighboursOfAHexagonAreSix) {
  const Tissue sheet = tissue_from_prisms(honeycomb(5, 5, 4, 12), PolygonSplit::diagonals, 1);
  const auto neighbours = wall_neighbours(sheet);
  EXPECT_EQ(neighbours[12].size(), 6u);
  CellSet one(25, false);
  one[12] = true;
  EXPECT_EQ(std::ranges::count(cells_around(sheet, one, 1), true), 6);
}

constexpr std::array<bool, 3> across_y = {false, true, false}, both = {true, true, false};

Tissue pill(std::array<int, 3> elements_per_cell = {1, 1, 1}) {
  return build_shell({300, 160, 30, {12, 8, 6}, elements_per_cell});
}

double sum_of_volumes(const Tissue& tissue) {
  double sum = 0;
  for (const Cell& cell : tissue.cells) sum += cell_volume(tissue, cell, tissue.rest_positions);
  return sum;
}

double sum(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum;
}

TEST(Mirror, OneSideIsAHalfOrAQuarter) {
  const std::vector<Tissue> wholes = {pill(), pill({2, 1, 2}), build_slice({14, 160, 30, {2, 8, 6}, {1, 1, 1}}),
                                      build_block({.length_um = 60, .width_um = 40, .cells = {6, 4, 2}})};
  for (const Tissue& whole : wholes)
    for (const auto& axes : {across_y, both}) {
      const MirroredSide side = side_of(whole, axes);
      const std::size_t times = axes[0] ? 4 : 2;
      EXPECT_EQ(side.tissue.cells.size() * times, whole.cells.size());
      EXPECT_EQ(side.tissue.elements.size() * times, whole.elements.size());
      EXPECT_EQ(side.tissue.apical_facets.size() * times, whole.apical_facets.size());
      EXPECT_NEAR(sum_of_volumes(side.tissue) * times, sum_of_volumes(whole), 1e-12 * sum_of_volumes(whole));
      const double area = sum(face_areas(whole, CellSide::apical, whole.rest_positions));
      EXPECT_NEAR(sum(face_areas(side.tissue, CellSide::apical, side.tissue.rest_positions)) * times, area,
                  1e-12 * area);
      double copies = 0;  // of nodes
      for (std::size_t n = 0; n < side.tissue.node_count(); ++n) {
        const NodeId node(n);
        copies += static_cast<double>(times) * side.tissue.side_share({&node, 1});
      }
      EXPECT_EQ(copies, static_cast<double>(whole.node_count()));
    }
}

TEST(Mirror, TheWholeIsWhereItWas) {
  const Tissue whole = pill({1, 2, 1});
  for (const auto& axes : {across_y, both}) {
    const auto [side, mirror] = side_of(whole, axes);
    const Vectors again = mirror.full_vectors(side.rest_positions);
    ASSERT_EQ(again.size(), whole.node_count());
    for (std::size_t n = 0; n < again.size(); ++n) EXPECT_LT((again[n] - whole.rest_positions[n]).norm(), 1e-10);
    for (const Vec3& x : side.rest_positions) EXPECT_TRUE(x.y() >= 0 && (!axes[0] || x.x() >= 0));
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
      Vec3 centre = cell_centre(whole.cells[c], whole.rest_positions);
      for (int axis = 0; axis < 2; ++axis)
        if (axes[axis]) centre[axis] = std::abs(centre[axis]);
      EXPECT_LT((cell_centre(side.cells[mirror.cells[c].index()], side.rest_positions) - centre).norm(), 1e-10);
      EXPECT_EQ(mirror.original(mirror.original(CellId(c))), mirror.original(CellId(c)));
    }
    for (std::size_t c = 0; c < side.cells.size(); ++c) {
      EXPECT_EQ(mirror.cells[mirror.origins[c].index()], CellId(c));
      EXPECT_EQ(side.cells[c].lineage.id, whole.cells[mirror.origins[c].index()].lineage.id);
      for (const CellLine& line : side.cells[c].lines)
        for (const NodeId node : line.chain.nodes) EXPECT_LT(node.index(), side.node_count());
    }
  }
}

// Walls count once in a whole: those on a plane are shared with the image.
TEST(Mirror, WallsOnThePlaneAreHalves) {
  const Tissue whole = pill();
  const Tissue side = side_of(whole, both).tissue;
  double walls = 0;
  int halves = 0;
  for (const Face& face : faces_of(side, CellSide::lateral)) {
    EXPECT_EQ(face.share == 1, face.beyond.has_value());
    walls += face.share;
    halves += face.share == 0.5 ? 1 : 0;
  }
  EXPECT_EQ(4 * walls, static_cast<double>(faces_of(whole, CellSide::lateral).size()));
  EXPECT_EQ(halves, 12 + 6 + 8 + 6);  // half a ring along, half a ring around
}

TEST(Mirror, WhatIsNotSymmetricIsRefused) {
  const auto complaint = [](const Tissue& whole) -> std::string {
    try {
      (void)side_of(whole, across_y);
    } catch (const NotSymmetric& error) {
      return std::string(error.what()) + "; " + error.remedy;
    }
    return "";
  };
  EXPECT_EQ(complaint(build_shell({300, 160, 30, {12, 7, 6}, {1, 1, 1}})),
            "the plane y = 0 cuts cells in two, for example cell 36; give an even number of cells along y");
  Tissue bent = pill();
  bent.rest_positions[40].z() += 0.1;
  EXPECT_SAYS(complaint(bent), "the mesh is not symmetric about the plane y = 0: it has a node at");
}

// Means over neighbours are those in the whole: cells that a plane touches have an image, once.
TEST(Mirror, NeighboursAndImagesAreThoseOfTheWhole) {
  const Tissue slice = build_slice({14, 160, 30, {2, 8, 6}, {1, 1, 1}});
  for (const Tissue& whole : {pill(), pill({2, 1, 2}), slice})
    for (const auto& axes : {across_y, both}) {
      const MirroredSide side = side_of(whole, axes);
      const auto of_whole = neighbours_and_images(whole), of_side = neighbours_and_images(side.tissue);
      for (std::size_t c = 0; c < of_side.size(); ++c) {
        std::vector<CellId> expected;
        for (const CellId cell : of_whole[side.mirror.origins[c].index()])
          expected.push_back(side.mirror.cells[cell.index()]);
        std::ranges::sort(expected);
        std::vector<CellId> found = of_side[c];
        std::ranges::sort(found);
        EXPECT_EQ(found, expected) << c;
      }
    }
}

}  // namespace
