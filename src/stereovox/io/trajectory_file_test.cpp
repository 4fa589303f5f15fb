#include "stereovox/io/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

const SE3 kPose{Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {1.25, -2.0 / 3.0, 1e-7}};

Trajectory two_poses() { return {{-1, SE3{}}, {1403636584763555765, kPose}}; }

std::string tum_complaint(const std::string& text) {
  const TemporaryFolder folder;
  try {
    read_tum(folder.write("a.tum", text));
  } catch (const Error& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

TEST(TrajectoryFile, TumLinesHaveExactTimesNineDigitsAndNoTrailingBlank) {
  const TemporaryFolder folder;
  write_tum(folder.path() / "a.tum", two_poses(), "left camera in the world\nt x y z");
  EXPECT_EQ(read_file(folder.path() / "a.tum", 1000),
            "# left camera in the world\n# t x y z\n"
            "-0.000000001 0 0 0 0 0 0 1\n"
            "1403636584.763555765 1.25 -0.666666667 1e-07 -0.5 0.5 0.5 0.5\n");
}

TEST(TrajectoryFile, TumIsReadAsWritten) {
  const TemporaryFolder folder;
  write_tum(folder.path() / "a.tum", two_poses(), "");
  const Trajectory read = read_tum(folder.path() / "a.tum");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].stamp_ns, -1);
  EXPECT_EQ(read[1].stamp_ns, 1403636584763555765);
  EXPECT_LT(log(inverse(read[1].T_world_camera) * kPose).norm(), 1e-8);
}

TEST(TrajectoryFile, TumQuaternionsAreNormalised) {
  const TemporaryFolder folder;
  const Trajectory read = read_tum(folder.write("a.tum", "0 0 0 0 0 0 0 2\n"));
  EXPECT_EQ(read[0].T_world_camera.rotation.w(), 1.0);
}

TEST(TrajectoryFile, BadTumLinesAreRefusedByNumber) {
  EXPECT_EQ(tum_complaint("# t\n0 0 0 0 0 0 0\n"), "a.tum:2: has 7 fields, 8 are needed");
  EXPECT_EQ(tum_complaint("0 0 nan 0 0 0 0 1\n"), "a.tum:1: field 3 is 'nan', not a finite number");
  EXPECT_EQ(tum_complaint("0 0 0 0 0 0 0 0\n"), "a.tum:1: the quaternion is zero");
  EXPECT_EQ(tum_complaint("1 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 1\n"),
            "a.tum:2: time 1.000000000 does not come after 1.000000000");
  EXPECT_EQ(tum_complaint("x 0 0 0 0 0 0 1\n"), "a.tum:1: field 1 is 'x', not a time in seconds");
}

TEST(TrajectoryFile, KittiPosesAreRowsOfTheMatrix) {
  const TemporaryFolder folder;
  write_kitti_poses(folder.path() / "a.txt", two_poses());
  EXPECT_EQ(read_file(folder.path() / "a.txt", 1000),
            "1 0 0 0 0 1 0 0 0 0 1 0\n"
            "0 -1 0 1.25 0 0 1 -0.666666667 -1 0 0 1e-07\n");
  const std::vector<SE3> read = read_kitti_poses(folder.path() / "a.txt");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_LT(log(inverse(read[1]) * kPose).norm(), 1e-8);
}

TEST(TrajectoryFile, EitherFormIsReadAndOneWithoutTimesGetsThem) {
  const TemporaryFolder folder;
  const fs::path tum = folder.path() / "a.tum", kitti = folder.path() / "a.txt";
  write_tum(tum, two_poses(), "");
  write_kitti_poses(kitti, two_poses());
  EXPECT_FALSE(holds_kitti_poses(tum));
  EXPECT_TRUE(holds_kitti_poses(kitti));
  const std::vector<std::int64_t> stamps_ns = {7, 9};
  EXPECT_EQ(read_poses(tum, stamps_ns).back().stamp_ns, two_poses().back().stamp_ns);
  const Trajectory read = read_poses(kitti, stamps_ns);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read.back().stamp_ns, 9);
  EXPECT_LT(log(inverse(read.back().T_world_camera) * kPose).norm(), 1e-8);
  try {
    read_poses(kitti, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("has 2 poses without times, for 0 frames"));
  }
}

TEST(TrajectoryFile, BadKittiPosesAreRefusedByNumber) {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& text) -> std::string {
    try {
      read_kitti_poses(folder.write("a.txt", text));
    } catch (const Error& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return "";
  };
  EXPECT_EQ(complaint("1 0 0 0 0 1 0 0 0 0 1\n"), "a.txt:1: has 11 fields, 12 are needed");
  EXPECT_EQ(complaint("1 0 0 0 0 1 0 0 0 0 1.1 0\n"),
            "a.txt:1: the 3x3 part is not a rotation (off by 0.21)");
  EXPECT_EQ(complaint("1 0 0 0 0 1 0 0 0 0 -1 0\n"),
            "a.txt:1: the 3x3 part is not a rotation (off by inf)");
}

}  // namespace
}  // namespace stereovox
