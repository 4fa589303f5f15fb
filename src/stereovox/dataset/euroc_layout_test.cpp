#include "stereovox/dataset/euroc_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/dataset/open_sequence.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kFirst_ns = 1403636587713555456, kStep_ns = 50'000'000;

// The body looks as the world does; the camera is rotated a quarter turn about the body's z.
std::string sensor(double y_m) {
  return "T_BS: [0, -1, 0, 0, 1, 0, 0, " + std::to_string(y_m) +
         ", 0, 0, 1, 0.3, 0, 0, 0, 1]\nresolution: [32, 20]\ncamera_model: pinhole\n"
         "intrinsics: [30, 30, 15.5, 9.5]\ndistortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.1, 0, 0, 0]\n";
}

class EurocLayout : public testing::Test {
 protected:
  EurocLayout() { write_set({0, 1, 2, 3, 4}, {0, 1'000'000, 0, 30'000'000, 0}); }

  // Left images at the given steps, right images later by `delay_ns`.
  void write_set(const std::vector<int>& steps, const std::vector<std::int64_t>& delay_ns) const {
    std::string left_table = "#timestamp [ns],filename\r\n", right_table = left_table;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::int64_t stamp_ns = kFirst_ns + steps[i] * kStep_ns;
      left_table += add_image("cam0", stamp_ns, steps[i]);
      right_table += add_image("cam1", stamp_ns + delay_ns[i], 100 + steps[i]);
    }
    write_text(root_ / "cam0" / "data.csv", left_table);
    write_text(root_ / "cam1" / "data.csv", right_table);
    write_text(root_ / "cam0" / "sensor.yaml", sensor(0.0));
    write_text(root_ / "cam1" / "sensor.yaml", sensor(0.11));
  }
  std::string add_image(const char* camera, std::int64_t stamp_ns, int mark) const {
    const std::string name = std::to_string(stamp_ns) + ".png";
    write_small_image(root_ / camera / "data" / name, mark);
    return std::to_string(stamp_ns) + "," + name + "\r\n";
  }

  TemporaryFolder folder_;
  fs::path root_ = folder_.path() / "mav0";
};

TEST_F(EurocLayout, PairsImagesWithinTheToleranceAndReadsTheRawRig) {
  const auto sequence = open_sequence(folder_.path());
  EXPECT_EQ(sequence->info().layout, "EuRoC/ASL");
  EXPECT_FALSE(sequence->rig().is_rectified);
  EXPECT_NEAR(sequence->rig().T_right_left.translation.x(), -0.11, 1e-12);
  EXPECT_EQ(sequence->info().left_only, 1);
  EXPECT_EQ(sequence->info().right_only, 1);
  EXPECT_EQ(sequence->next()->stamp_ns, kFirst_ns);
  EXPECT_EQ(sequence->next()->stamp_ns, kFirst_ns + kStep_ns);
  EXPECT_THAT(left_marks(*sequence), ElementsAre(2, 4));
}

TEST_F(EurocLayout, OpensFromTheInnerFolderAndWithoutTables) {
  fs::remove(root_ / "cam0" / "data.csv");
  fs::remove(root_ / "cam1" / "data.csv");
  EXPECT_THAT(left_marks(*open_sequence(root_)), ElementsAre(0, 1, 2, 4));
  write_small_image(root_ / "cam0" / "data" / "extra.png", 9);
  EXPECT_THAT(complaint_about(root_),
              HasSubstr("extra.png: its name is not a time in nanoseconds"));
}

TEST_F(EurocLayout, GivesTheTruthOfTheLeftCameraNotOfTheBody) {
  write_text(root_ / "state_groundtruth_estimate0" / "data.csv",
             "#timestamp,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,ax,ay,az\n" +
                 std::to_string(kFirst_ns) + ",1,2,3,0.5,0.5,0.5,0.5,0,0,0,0,0,0,0,0,0\n");
  const Trajectory truth = open_sequence(folder_.path())->truth();
  ASSERT_EQ(truth.size(), 1U);
  EXPECT_EQ(truth[0].stamp_ns, kFirst_ns);
  // The body is turned so that its z is the world's x: the camera is 0.3 m along world x.
  EXPECT_LT((truth[0].T_world_camera.translation - Eigen::Vector3d(1.3, 2.0, 3.0)).norm(), 1e-12);
  // The camera's x is the body's y, which is the world's z.
  EXPECT_LT((truth[0].T_world_camera.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ())
                .norm(),
            1e-12);
}

TEST_F(EurocLayout, ReportsWhatItsTablesPromiseButDoNotHold) {
  fs::remove(root_ / "cam0" / "data" / (std::to_string(kFirst_ns + 2 * kStep_ns) + ".png"));
  const auto sequence = open_sequence(folder_.path());
  EXPECT_THAT(sequence->info().remarks,
              Contains("cam0/data.csv: 1 images are not there, first: " +
                       std::to_string(kFirst_ns + 2 * kStep_ns) + ".png"));
  EXPECT_EQ(sequence->info().gaps, 1);
  EXPECT_THAT(left_marks(*sequence), ElementsAre(0, 1, 4));
}

TEST_F(EurocLayout, DropsEntriesThatGoBackInTime) {
  fs::remove_all(root_);
  write_set({0, 1, 3, 2, 4}, {0, 0, 0, 0, 0});
  const auto sequence = open_sequence(folder_.path());
  EXPECT_THAT(left_marks(*sequence), ElementsAre(0, 1, 3, 4));
}

TEST_F(EurocLayout, RefusesCamerasThatNeverSeeTheSameMoment) {
  fs::remove_all(root_);
  write_set({0, 2, 4}, {30'000'000, 30'000'000, 30'000'000});
  EXPECT_THAT(complaint_about(folder_.path()),
              HasSubstr("mav0: no left and right image are within 0.005 s of each other"));
  SequenceParams tolerant;
  tolerant.max_stamp_difference_s = 0.04;
  EXPECT_THAT(left_marks(*open_sequence(folder_.path(), tolerant)), ElementsAre(0, 2, 4));
}

TEST_F(EurocLayout, WithoutTheRightCameraNamesItsFolder) {
  fs::remove_all(root_ / "cam1");
  EXPECT_EQ(complaint_about(folder_.path()),
            (root_ / "cam1" / "data").string() + ": no right images (PNG, PGM, JPEG, BMP, TIFF)");
}

}  // namespace
}  // namespace stereovox
