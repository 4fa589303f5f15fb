#include "stereovox/dataset/kitti_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/dataset/open_sequence.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kCalibration =
    "P0: 30 0 15.5 0 0 30 9.5 0 0 0 1 0\nP1: 30 0 15.5 -15 0 30 9.5 0 0 0 1 0\n"
    "P2: 30 0 15.5 3 0 30 9.5 0 0 0 1 0\nP3: 30 0 15.5 -15 0 30 9.5 0 0 0 1 0\n";

class KittiLayout : public testing::Test {
 protected:
  KittiLayout() { write_set(0, 1); }

  void write_set(int left, int right) const {
    for (int i = 0; i < 3; ++i) {
      write_small_image(folder_ / ("image_" + std::to_string(left)) / image_name(i), i);
      write_small_image(folder_ / ("image_" + std::to_string(right)) / image_name(i), 100 + i);
    }
    write_text(folder_ / "calib.txt", kCalibration);
    write_text(folder_ / "times.txt", "0.000000e+00\n1.037359e-01\n2.074718e-01\n");
  }

  TemporaryFolder root_;
  fs::path folder_ = root_.path() / "sequences" / "07";
  fs::path poses_ = root_.path() / "poses" / "07.txt";
  std::string poses_text_ =
      "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n"
      "1 0 0 5 0 1 0 0 0 0 1 2\n";
};

TEST_F(KittiLayout, DeliversTheGreyPairsWithTheirTimes) {
  const auto sequence = open_sequence(folder_);
  EXPECT_EQ(sequence->info().layout, "KITTI odometry");
  EXPECT_EQ(sequence->rig().baseline_m(), 0.5);
  EXPECT_EQ(sequence->rig().left.pinhole.width, kSmallWidth);
  EXPECT_TRUE(sequence->rig().is_rectified);
  EXPECT_TRUE(sequence->truth().empty());
  sequence->next();
  EXPECT_EQ(sequence->next()->stamp_ns, 103'735'900);
}

TEST_F(KittiLayout, FindsItsPosesBesideTheSequences) {
  write_text(poses_, poses_text_);
  for (const fs::path& folder : {folder_, folder_ / ""}) {
    const Trajectory truth = open_sequence(folder)->truth();
    ASSERT_EQ(truth.size(), 3U);
    EXPECT_EQ(truth[2].stamp_ns, 207'471'800);
    EXPECT_EQ(truth[2].T_world_camera.translation, Eigen::Vector3d(5, 0, 2));
  }
  write_text(folder_ / "poses.txt", "1 0 0 7 0 1 0 0 0 0 1 0\n" + poses_text_.substr(24));
  EXPECT_EQ(open_sequence(folder_)->truth()[0].T_world_camera.translation.x(), 7.0);
}

TEST_F(KittiLayout, GivesTheTruthOfTheLeftColourCamera) {
  fs::remove_all(folder_);
  write_set(2, 3);
  write_text(poses_, poses_text_);
  const auto sequence = open_sequence(folder_);
  EXPECT_NEAR(sequence->rig().baseline_m(), 0.6, 1e-12);
  EXPECT_NEAR(sequence->truth()[2].T_world_camera.translation.x(), 4.9, 1e-12);
}

TEST_F(KittiLayout, RefusesPosesOfAnotherLength) {
  write_text(poses_, poses_text_ + poses_text_);
  EXPECT_THAT(complaint_about(folder_), HasSubstr("07.txt: has 6 poses, times.txt has 3 times"));
}

TEST_F(KittiLayout, TakesItsSizeFromTheFirstImageThatCanBeRead) {
  write_text(folder_ / "image_0" / image_name(0), "");
  SequenceParams forgiving;
  forgiving.max_skipped_percent = 50.0;
  EXPECT_EQ(complaint_about(folder_, forgiving), "");
  for (int i = 0; i < 3; ++i) write_text(folder_ / "image_0" / image_name(i), "");
  EXPECT_THAT(complaint_about(folder_), HasSubstr("image_0/000000.png: is empty"));
}

}  // namespace
}  // namespace stereovox
