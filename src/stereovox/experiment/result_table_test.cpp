#include "stereovox/experiment/result_table.h"

#include <gmock/gmock.h>

#include <fstream>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using testing::HasSubstr;

ResultRow row(const std::string& world, int seed, const std::string& method, double correlation) {
  return {{.group = "G", .world = world, .method = method, .seed = seed, .cell_size_m = 0.25},
          {{"ternary_correlation", correlation}, {"ternary_map_score_all", 10 * correlation}}};
}

const std::vector<ResultRow> kRows = {row("a", 1, "good", 0.9), row("a", 2, "good", 0.7),
                                      row("b", 1, "good", 0.8), row("a", 1, "bad", 0.2),
                                      row("a", 2, "bad", 0.2)};

MethodGroup group() {
  return {.title = "G",
          .cell_sizes_m = {0.25},
          .pose_sources = {PoseSource::truth},
          .seeds = {1, 2},
          .methods = {{"good", OccupancyMethod{}, ""}, {"bad", OccupancyMethod{}, ""}}};
}

TEST(MeanAndDeviation, IsThatOfASample) {
  const MeanAndDeviation m = mean_and_deviation(std::vector{1.0, 2.0, 3.0, 6.0});
  EXPECT_DOUBLE_EQ(m.mean, 3.0);
  EXPECT_DOUBLE_EQ(m.deviation, std::sqrt(14.0 / 3));
  EXPECT_EQ(m.count, 4);
  EXPECT_EQ(mean_and_deviation(std::vector{5.0}).deviation, 0.0);
  EXPECT_EQ(mean_and_deviation(std::vector<double>{}).count, 0);
}

TEST(ToMarkdown, AveragesOverRunsAndRanksEachColumn) {
  const std::string table = to_markdown(kRows, group(), 0.25, PoseSource::truth, "");
  EXPECT_THAT(table, HasSubstr("| good | **80.00 ± 10.00** (1) | 8.00 ± 1.00 (2) | n/a |"));
  EXPECT_THAT(table, HasSubstr("| bad | 20.00 ± 0.00 (2) | **2.00 ± 0.00** (1) | n/a |"));
}

TEST(ToMarkdown, OfOneWorldTakesItsRunsOnly) {
  const std::string table = to_markdown(kRows, group(), 0.25, PoseSource::truth, "b");
  EXPECT_THAT(table, HasSubstr("| good | **80.00 ± 0.00** (1) |"));
  EXPECT_THAT(table, HasSubstr("| bad | n/a |"));
}

TEST(ToMarkdown, OtherCellSizesAndPosesDoNotCount) {
  EXPECT_THAT(to_markdown(kRows, group(), 0.1, PoseSource::truth, ""), HasSubstr("| good | n/a |"));
  EXPECT_THAT(to_markdown(kRows, group(), 0.25, PoseSource::estimated, ""),
              HasSubstr("| good | n/a |"));
}

class RowsFile : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "rows.json";
};

TEST_F(RowsFile, IsReadBackForItsKeyOnly) {
  EXPECT_EQ(read_rows(path_, "k"), std::nullopt);
  write_rows(path_, "k", kRows);
  const auto rows = read_rows(path_, "k");
  ASSERT_TRUE(rows.has_value());
  ASSERT_EQ(rows->size(), kRows.size());
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    EXPECT_EQ((*rows)[i].of, kRows[i].of);
    EXPECT_EQ((*rows)[i].values, kRows[i].values);
  }
  EXPECT_EQ(read_rows(path_, "other"), std::nullopt);
}

TEST_F(RowsFile, ThatIsCutOffIsAnError) {
  std::ofstream(path_) << "{\"key\": \"k\", \"rows\": [{\"gro";
  EXPECT_THROW(read_rows(path_, "k"), Error);
}

TEST_F(RowsFile, CsvHasAColumnForEachFigure) {
  write_csv(path_, kRows);
  std::ifstream file(path_);
  std::string header, first;
  std::getline(file, header);
  std::getline(file, first);
  EXPECT_EQ(header,
            "group,world,seed,poses,cell_size_m,method,ternary_correlation,ternary_map_score_all");
  EXPECT_EQ(first, "G,a,1,truth,0.25,good,0.9,9");
}

}  // namespace
}  // namespace stereovox
