#include "tissue/shapes/given_prisms.hpp"

#include <algorithm>

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "support/whole.hpp"
#include "tissue/files/prism_file.hpp"
#include "tissue/mesh_quality.hpp"

namespace {

// Its basal side leans and is narrower.
PrismSheet leaning_sheet() {
  PrismSheet sheet = honeycomb(6, 5, 4, 12);
  for (Vec3& x : sheet.basal) x = Vec3(0.8 * x.x() + 3, 0.9 * x.y(), x.z());
  return sheet;
}

SurfaceTissue built(const PrismSheet& sheet, bool mend = true) { return build_prisms({sheet, {}}, {}, mend, {}); }

std::string refusal(const PrismSheet& sheet, bool mend = true) {
  return error_of<MeshError>([&] { built(sheet, mend); });
}

TEST(GivenPrisms, AreTheCellsExactly) {
  const PrismSheet sheet = leaning_sheet();
  const SurfaceTissue made = built(sheet);
  EXPECT_EQ(made.tissue.cells.size(), sheet.cells.size());
  EXPECT_TRUE(made.tissue.remarks.empty());
  const std::vector<double> volumes = prism_volumes(sheet);
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    const Cell& cell = made.tissue.cells[c];
    EXPECT_NEAR(cell_volume(made.tissue, cell, made.tissue.rest_positions), volumes[c], 1e-9 * volumes[c]);
    for (std::size_t k = 0; k < cell.sides(); ++k)
      EXPECT_EQ(made.tissue.rest_positions[cell.basal_corners()[k].index()], sheet.basal[sheet.cells[c][k]]);
  }
  expect_faces_enclose_the_cells(made.tissue);
  EXPECT_FALSE(made.tissue.outer_shape.has_value());
  EXPECT_SAYS(made.why_no_shape, "boundary");
}

// Where cells touch on one side only, an edge has no length on the other.
TEST(GivenPrisms, AnEdgeWithoutLengthOnOneSideIsLengthened) {
  PrismSheet sheet = honeycomb(6, 5, 4, 12);
  const auto& middle = sheet.cells[14];
  const Vec3 at = 0.5 * (sheet.basal[middle[0]] + sheet.basal[middle[1]]);
  sheet.basal[middle[0]] = sheet.basal[middle[1]] = at;
  EXPECT_SAYS(refusal(sheet, false), "set mend = true");
  const SurfaceTissue made = built(sheet);
  EXPECT_GT(min_scaled_jacobian(made.tissue, made.tissue.rest_positions), 0.15);
  ASSERT_FALSE(made.tissue.remarks.empty());
  EXPECT_SAYS(made.tissue.remarks.front(), "basal side: 1 short edges");
}

TEST(GivenPrisms, RefusesWhatIsNoLayer) {
  PrismSheet turned = leaning_sheet();
  for (auto& cell : turned.cells) std::ranges::reverse(cell);
  EXPECT_SAYS(refusal(turned), "order corners counter-clockwise seen from the apical side");
  PrismSheet apart = leaning_sheet();
  apart.cells = {apart.cells.front(), apart.cells.back()};
  EXPECT_SAYS(refusal(apart), "2 pieces of 1 and 1 cells");
  PrismSheet twisted = leaning_sheet();
  std::ranges::rotate(twisted.basal, twisted.basal.begin() + 9);
  EXPECT_FALSE(refusal(twisted).empty());
}

PolygonFile file_of(const PrismSheet& sheet) {
  PolygonFile file{{sheet.apical, {}}, {}};
  file.surface.vertices.insert(file.surface.vertices.end(), sheet.basal.begin(), sheet.basal.end());
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (const bool is_apical : {false, true}) {
      auto& face = file.surface.polygons.emplace_back(sheet.cells[c]);
      if (!is_apical)
        for (std::size_t& vertex : face) vertex += sheet.apical.size();
      file.arrays["cell"].push_back(static_cast<double>(10 * c));
      file.arrays["is_apical"].push_back(is_apical ? 1 : 0);
      file.arrays["gene"].push_back(is_apical ? static_cast<double>(c) : -1);
    }
  return file;
}

TEST(PrismFile, HasBothPolygonsOfEachCell) {
  const PrismSheet sheet = leaning_sheet();
  const GivenPrisms prisms = prisms_in(file_of(sheet));
  ASSERT_EQ(prisms.sheet.cells.size(), sheet.cells.size());
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (std::size_t k = 0; k < sheet.cells[c].size(); ++k) {
      EXPECT_EQ(prisms.sheet.apical[prisms.sheet.cells[c][k]], sheet.apical[sheet.cells[c][k]]);
      EXPECT_EQ(prisms.sheet.basal[prisms.sheet.cells[c][k]], sheet.basal[sheet.cells[c][k]]);
    }
  EXPECT_EQ(prisms.arrays.at("gene")[3], 3);
  EXPECT_EQ(prisms.arrays.at("cell")[3], 30);
  EXPECT_FALSE(prisms.arrays.contains("is_apical"));
}

TEST(PrismFile, NamesWhatIsWrong) {
  const auto refused = [](const auto& damage) {
    PolygonFile file = file_of(leaning_sheet());
    damage(file);
    return error_of<MeshError>([&] { prisms_in(file); });
  };
  EXPECT_SAYS(refused([](PolygonFile& file) { file.arrays.erase("is_apical"); }), "no face array \"is_apical\"");
  EXPECT_SAYS(refused([](PolygonFile& file) { file.arrays["is_apical"][4] = 1; }), "cell 20 has two apical faces");
  EXPECT_SAYS(refused([](PolygonFile& file) { file.arrays["cell"][5] = 21; }), "cell 20 has no apical face");
  EXPECT_SAYS(refused([](PolygonFile& file) { file.surface.polygons[2].pop_back(); }), "6 apical and 5 basal corners");
  EXPECT_SAYS(refused([](PolygonFile& file) {
                auto& face = file.surface.polygons[2];
                std::rotate(face.begin(), face.begin() + 1, face.end());
              }),
              "list basal corners in the order of the apical ones");
}

}  // namespace
