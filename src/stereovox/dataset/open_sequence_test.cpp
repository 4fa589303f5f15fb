#include "stereovox/dataset/open_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/core/error.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(OpenSequence, RefusesAFolderOfNoKnownLayoutAndSaysWhatItLookedFor) {
  const TemporaryFolder folder;
  EXPECT_EQ(complaint_about(folder.path()),
            folder.path().string() +
                ": is not a stereo sequence; looked for left/ and right/ (plain), image_0/ and "
                "image_1/ or image_2/ and image_3/ (KITTI odometry), mav0/ or cam0/ and cam1/ "
                "(EuRoC/ASL)");
  EXPECT_EQ(complaint_about(folder.path() / "none"),
            (folder.path() / "none").string() + ": no such folder");
  EXPECT_EQ(complaint_about(folder.write("a.bag", "x")),
            (folder.path() / "a.bag").string() + ": is a file, a folder of images is needed");
  EXPECT_EQ(complaint_about(folder.write("b.bag", "#ROSBAG V2.0\n")),
            (folder.path() / "b.bag").string() + ": is a ROS 1 bag, a folder of images is needed");
}

TEST(OpenSequence, RefusesLinksInACircle) {
  const TemporaryFolder folder;
  fs::create_symlink("left", folder.path() / "left");
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("left: cannot be opened (Too many levels"));
}

TEST(OpenSequence, TakesAnotherCalibrationWhenGiven) {
  const TemporaryFolder folder;
  write_small_plain_set(folder.path(), 2);
  fs::rename(folder.path() / "calib.yaml", folder.path() / "mine.yaml");
  EXPECT_EQ(open_sequence(folder.path(), {}, folder.path() / "mine.yaml")->rig().baseline_m(),
            0.12);
  write_text(folder.path() / "mine.yaml", "width: 32\n");
  EXPECT_THROW(open_sequence(folder.path(), {}, folder.path() / "mine.yaml"), Error);
}

TEST(OpenSequence, RefusesACalibrationThatCannotBeUsedByItsName) {
  const TemporaryFolder folder;
  write_small_plain_set(folder.path(), 2);
  std::string text = kSmallCalibration;
  write_text(folder.path() / "calib.yaml", text.replace(text.find("0.12"), 4, "120"));
  EXPECT_EQ(complaint_about(folder.path()),
            (folder.path() / "calib.yaml").string() +
                ": baseline is 120 m, outside [0.005, 10] m; is it in millimetres?");
  write_text(folder.path() / "calib.yaml", "fx: " + std::string(200000, '[') + "\n");
  EXPECT_EQ(complaint_about(folder.path()),
            (folder.path() / "calib.yaml").string() + ":1: nested more than 32 deep");
}

TEST(OpenSequence, ParametersAreInRangeByDefault) {
  SequenceParams params;
  const ParameterList list = parameters_of(params);
  for (const Parameter& parameter : list.parameters())
    EXPECT_NO_THROW(parameter.set(parameter.get())) << parameter.path;
}

}  // namespace
}  // namespace stereovox
