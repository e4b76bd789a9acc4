#include "tissue/lattice.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using Segment = std::pair<NodeId, NodeId>;
using Place = std::pair<CellSide, EdgeDirection>;

const ShellShape refined{.cells = {6, 5, 4}, .elements_per_cell = {3, 2, 2}};

void add_segments(const std::vector<NodeId>& chain, std::multiset<Segment>& segments) {
  for (std::size_t s = 1; s < chain.size(); ++s) segments.insert(std::minmax(chain[s - 1], chain[s]));
}

TEST(Lattice, SharesOfTheLinesOfASideAndDirectionAddUpToTwo) {
  const Tissue tissue = build_shell(refined);
  int cases = 0;
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
        ++cases;
      }
    EXPECT_EQ((sums.at({CellSide::lateral, EdgeDirection::lateral})), 4);
    EXPECT_EQ((lines.at({CellSide::lateral, EdgeDirection::lateral})), 4u);
    EXPECT_EQ((segments.at({CellSide::lateral, EdgeDirection::lateral})), 2u);
  }
  RecordProperty("cases", cases);
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
  int cases = 0;
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
      ++cases;
    }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
