#include "stereovox/navmap/distance_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

CellMask drawn_sites(const Drawing& drawing, double cell_size_m) {
  return cells_labelled(drawn_grid(drawing, cell_size_m), CellLabel::occupied);
}

TEST(DistanceField, GivesTheDistanceBetweenCellCentresAndNamesTheNearestSite) {
  const DistanceField2D field = distance_field(drawn_sites({"....#",  //
                                                            ".....",  //
                                                            "#...."},
                                                           0.25));
  EXPECT_DOUBLE_EQ(field.at(0), 0.0);
  EXPECT_DOUBLE_EQ(field.at(1), 0.25);
  EXPECT_DOUBLE_EQ(field.at(6), 0.25 * std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(field.at(9), 0.25);
  EXPECT_EQ(field.nearest[6], 0);
  EXPECT_EQ(field.nearest[9], 14);
}

TEST(DistanceField, OfAnEmptySetIsInfiniteAndNamesNoCell) {
  const DistanceField2D field = distance_field(drawn_sites({"..", ".?"}, 0.1));
  EXPECT_TRUE(std::isinf(field.at(3)));
  EXPECT_EQ(field.nearest[3], kNoCell);
}

int nearest_by_search(const CellMask& sites, int position) {
  const auto squared = [&](int site) {
    return (cell_in(sites.geometry, site) - cell_in(sites.geometry, position)).squaredNorm();
  };
  int best = kNoCell;
  for (int x = 0; x < sites.geometry.width; ++x)
    for (int y = 0; y < sites.geometry.height; ++y) {
      const int site = position_in(sites.geometry, {x, y});
      if (sites.has(site) && (best == kNoCell || squared(site) < squared(best))) best = site;
    }
  return best;
}

TEST(DistanceField, EqualsTheSearchThroughAllSites) {
  std::mt19937 random(7);
  for (const unsigned sparseness : {3U, 20U, 150U}) {
    CellMask sites = empty_mask({{0, 0}, 1.0, 23, 17});
    for (int i = 0; i < cell_count(sites.geometry); ++i) sites.set(i, random() % sparseness == 0);
    const DistanceField2D field = distance_field(sites);
    for (int i = 0; i < cell_count(sites.geometry); ++i)
      ASSERT_EQ(field.nearest[static_cast<std::size_t>(i)], nearest_by_search(sites, i)) << i;
  }
}

}  // namespace
}  // namespace stereovox
