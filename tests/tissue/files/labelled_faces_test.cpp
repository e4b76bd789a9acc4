#include "tissue/files/labelled_faces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/mesh_error.hpp"

namespace plica {
namespace {

// A grid of squares of two triangles each, with labels row by row.
PolygonFile triangles(const std::vector<std::vector<int>>& labels) {
  PolygonFile file;
  const std::size_t n = labels.size();
  for (std::size_t r = 0; r <= n; ++r)
    for (std::size_t c = 0; c <= n; ++c)
      file.surface.vertices.emplace_back(static_cast<double>(c), static_cast<double>(r), 0);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n; ++c) {
      const std::size_t v = c + r * (n + 1);
      file.surface.polygons.push_back({v, v + 1, v + n + 2});
      file.surface.polygons.push_back({v, v + n + 2, v + n + 1});
      for (int i = 0; i < 2; ++i) {
        file.arrays["label"].push_back(labels[r][c]);
        file.arrays["gene"].push_back(labels[r][c] + i);
      }
    }
  return file;
}

TEST(LabelledFaces, FacesOfALabelAreACellWhoseCornersAreWhereThreeMeet) {
  // Bricks: the middle one, 5, has six neighbours.
  const PolygonFile file = triangles({{1, 1, 1, 2, 2, 2},
                                      {1, 1, 1, 2, 2, 2},
                                      {3, 5, 5, 5, 5, 4},
                                      {3, 5, 5, 5, 5, 4},
                                      {6, 6, 6, 7, 7, 7},
                                      {6, 6, 6, 7, 7, 7}});
  const PolygonFile cells = cells_of_labels(file, "label");
  ASSERT_EQ(cells.arrays.at("label"), (CellArray{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(cells.arrays.at("gene").at(4), 5.5);
  const auto& middle = cells.surface.polygons[4];
  ASSERT_EQ(middle.size(), 6U);
  for (const std::size_t corner : middle) {
    const Vec3& p = cells.surface.vertices[corner];
    EXPECT_TRUE((p.y() == 2 || p.y() == 4) && (p.x() == 1 || p.x() == 3 || p.x() == 5)) << p.transpose();
  }
  EXPECT_GT(area_vector(cells.surface.vertices, middle).z(), 0);
  EXPECT_EQ(cells.surface.polygons[0].size(), 4U);  // three within, one at the rim
  EXPECT_EQ(label_advice(cells), "");
  EXPECT_NE(label_advice(file).find("its 72 faces are triangles with 7 values of \"label\""), std::string::npos);
}

TEST(LabelledFaces, WhatIsNoCellIsRefusedOrLeftOut) {
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 2}, {2, 1}}), "label");
      },
      "the faces with label 1 are in pieces, or enclose others; correct the labels near (0, 0, 0) um");
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 1, 1}, {1, 2, 1}, {1, 1, 1}}), "label");
      },
      "the faces with label 1 are in pieces, or enclose others");
  expect_mesh_error(
      [] {
        cells_of_labels(triangles({{1, 1}, {2, 2}}), "label");
      },
      "no label of \"label\" has faces with three corners where three cells meet");
  PolygonFile holed = triangles({{0, 1, 1, 2, 2, 0},
                                 {0, 1, 1, 2, 2, 0},
                                 {0, 3, 3, 3, 3, 0},
                                 {0, 3, 3, 3, 3, 0},
                                 {0, 0, 0, 0, 0, 0},
                                 {9, 0, 0, 0, 0, 0}});
  for (double& label : holed.arrays["label"])
    if (label == 0) label = std::nan("");
  const PolygonFile cells = cells_of_labels(holed, "label");
  EXPECT_EQ(cells.arrays.at("label"), (CellArray{1, 2, 3}));
  ASSERT_EQ(cells.remarks.size(), 1U);
  EXPECT_EQ(cells.remarks[0], "1 cells with fewer than three corners were omitted");
}

}  // namespace
}  // namespace plica
