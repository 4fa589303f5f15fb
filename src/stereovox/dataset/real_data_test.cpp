// Real recordings, read whole.
#include <gtest/gtest.h>

#include <ostream>

#include "stereovox/core/timestamp.h"
#include "stereovox/dataset/open_sequence.h"
#include "stereovox/dataset/read_ahead.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct Expected {
  const char* name;
  const char* layout;
  int pairs, width, height;
  double fx_px, baseline_m;
  bool is_rectified;
  std::int64_t first_ns, last_ns;
  std::size_t truth;
};

std::ostream& operator<<(std::ostream& out, const Expected& expected) {
  return out << expected.name;
}

class RealData : public testing::TestWithParam<Expected> {};

TEST_P(RealData, IsReadWhole) {
  const Expected& expected = GetParam();
  const fs::path folder = fs::path(STEREOVOX_SHARED_DIR) / "data" / expected.name;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not here";
  const std::unique_ptr<StereoSequence> sequence = read_ahead(open_sequence(folder), 4);
  EXPECT_EQ(sequence->info().layout, expected.layout);
  EXPECT_EQ(sequence->info().pairs, expected.pairs);
  EXPECT_TRUE(sequence->info().remarks.empty()) << sequence->info().remarks.front();
  EXPECT_EQ(sequence->rig().is_rectified, expected.is_rectified);
  EXPECT_EQ(sequence->rig().left.pinhole.width, expected.width);
  EXPECT_EQ(sequence->rig().left.pinhole.height, expected.height);
  EXPECT_NEAR(sequence->rig().left.pinhole.fx_px, expected.fx_px, 1e-9);
  EXPECT_NEAR(sequence->rig().baseline_m(), expected.baseline_m, 1e-6);
  EXPECT_EQ(sequence->truth().size(), expected.truth);

  std::vector<std::int64_t> stamps_ns;
  while (const std::optional<StereoFrame> frame = sequence->next()) {
    EXPECT_EQ(frame->index, static_cast<int>(stamps_ns.size()));
    stamps_ns.push_back(frame->stamp_ns);
  }
  ASSERT_EQ(stamps_ns.size(), static_cast<std::size_t>(expected.pairs));
  EXPECT_EQ(stamps_ns.front(), expected.first_ns);
  EXPECT_EQ(stamps_ns.back(), expected.last_ns);
  EXPECT_TRUE(sequence->skipped().empty());
}

INSTANTIATE_TEST_SUITE_P(
    , RealData,
    testing::Values(Expected{"office_a", "plain", 200, 640, 480, 524.8, 0.12, true, 0,
                             79'600'000'000, 200},
                    Expected{"euroc_mh01", "plain", 340, 376, 240, 221.399442, 0.110077842, true,
                             1403636584763555765, 1403636601713555574, 340},
                    Expected{"kitti_seq1", "plain", 51, 1226, 370, 707.0912, 0.537150653, true, 0,
                             5'186'800'000, 51},
                    Expected{"euroc_raw", "EuRoC/ASL", 20, 752, 480, 458.654, 0.110077842, false,
                             1403636587713555456, 1403636589613555456, 0},
                    Expected{"euroc_still", "EuRoC/ASL", 4, 752, 480, 458.654, 0.110077842, false,
                             1403715273262142976, 1403715273412143104, 0}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace stereovox
