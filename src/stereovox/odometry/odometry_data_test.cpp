// Odometry on real and rendered sequences with truth; skipped where these are not installed.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "stereovox/core/timestamp.h"
#include "stereovox/odometry/odometry.h"

namespace stereovox {
namespace {

constexpr double kDegrees = 180.0 / M_PI;

struct Sequence {
  std::filesystem::path folder;
  RectifiedCamera camera;
  std::vector<double> times_s;
  std::vector<SE3> T_world_camera;
  cv::Ptr<cv::StereoSGBM> matcher = cv::StereoSGBM::create(0, 64, 3, 8 * 9, 32 * 9, 1, 31, 10, 100,
                                                           2, cv::StereoSGBM::MODE_SGBM_3WAY);
};

RectifiedCamera read_camera(const std::filesystem::path& path) {
  std::map<std::string, double> values;
  std::ifstream file(path);
  for (std::string line, key; std::getline(file, line);) {
    std::istringstream words(line);
    double value = 0.0;
    if (words >> key >> value) values[key] = value;
  }
  return {{static_cast<int>(values["width:"]), static_cast<int>(values["height:"]), values["fx:"],
           values["fy:"], values["cx:"], values["cy:"]},
          values["baseline:"]};
}

Sequence open(const std::string& name) {
  Sequence sequence;
  sequence.folder = std::filesystem::path(STEREOVOX_SHARED_DIR) / "data" / name;
  sequence.camera = read_camera(sequence.folder / "calib.yaml");
  std::ifstream poses(sequence.folder / "poses.txt");
  for (std::string line; std::getline(poses, line);) {
    std::istringstream words(line);
    double t, x, y, z, qx, qy, qz, qw;
    if (!(words >> t >> x >> y >> z >> qx >> qy >> qz >> qw)) continue;
    sequence.times_s.push_back(t);
    sequence.T_world_camera.push_back({Eigen::Quaterniond(qw, qx, qy, qz).normalized(), {x, y, z}});
  }
  return sequence;
}

cv::Mat1b read_image(const std::filesystem::path& folder, std::size_t index) {
  for (const char* ending : {".png", ".jpg"}) {
    std::ostringstream name;
    name << std::string(6 - std::min<std::size_t>(6, std::to_string(index).size()), '0') << index
         << ending;
    if (std::filesystem::exists(folder / name.str()))
      return cv::imread((folder / name.str()).string(), cv::IMREAD_GRAYSCALE);
  }
  return {};
}

OdometryResult track(Odometry& odometry, Sequence& sequence, std::size_t index) {
  RectifiedPair pair;
  pair.stamp_ns = ns_from_seconds(sequence.times_s[index]);
  pair.left.pixels = read_image(sequence.folder / "left", index);
  pair.right.pixels = read_image(sequence.folder / "right", index);
  cv::Mat sixteenths, disparity_px;
  sequence.matcher->compute(pair.left.pixels, pair.right.pixels, sixteenths);
  sixteenths.convertTo(disparity_px, CV_32F, 1.0 / 16.0);
  disparity_px.setTo(0.0F, disparity_px < 0.0F);
  return odometry.track(pair, {disparity_px, cv::Mat1f(disparity_px.size(), 0.35F)});
}

// What happened to every `stride`-th frame.
struct Journey {
  int frames = 0, tracked = 0, wrong_steps = 0;
  double way_m = 0.0, end_error_m = 0.0;
};

Journey travel(const std::string& name, std::size_t stride) {
  Sequence sequence = open(name);
  Odometry odometry(sequence.camera, {});
  Journey journey;
  SE3 last_truth, last_pose, first_truth;
  for (std::size_t i = 0; i < sequence.times_s.size(); i += stride, ++journey.frames) {
    const OdometryResult result = track(odometry, sequence, i);
    const SE3& truth = sequence.T_world_camera[i];
    if (journey.frames == 0) first_truth = last_truth = truth;
    journey.way_m += (truth.translation - last_truth.translation).norm();
    if (result.status == OdometryStatus::lost || result.segment != 0) continue;
    ++journey.tracked;
    const SE3 error =
        inverse(inverse(last_truth) * truth) * (inverse(last_pose) * result.T_segment_camera);
    if (error.translation.norm() > 0.1 || rotation_angle_rad(error) * kDegrees > 1.0)
      ++journey.wrong_steps;
    last_truth = truth;
    last_pose = result.T_segment_camera;
    journey.end_error_m = (first_truth * last_pose.translation - truth.translation).norm();
  }
  return journey;
}

class OdometryOnData : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(std::string(STEREOVOX_SHARED_DIR) + "/data"))
      GTEST_SKIP() << "the shared data sets are not installed";
  }
};

TEST_F(OdometryOnData, FollowsAShakyFlight) {
  const Journey flight = travel("euroc_mh01", 2);
  EXPECT_EQ(flight.tracked, flight.frames);
  EXPECT_EQ(flight.wrong_steps, 0);
  EXPECT_LT(flight.end_error_m, 0.005 * flight.way_m);
}

TEST_F(OdometryOnData, FollowsAShakyFlightAtTwoFramesPerSecond) {
  const Journey flight = travel("euroc_mh01", 10);
  EXPECT_GE(flight.tracked, flight.frames - 3);
  EXPECT_EQ(flight.wrong_steps, 0);
}

TEST_F(OdometryOnData, FollowsARobotThroughAnOffice) {
  const Journey drive = travel("office_a", 1);
  EXPECT_EQ(drive.tracked, drive.frames);
  EXPECT_EQ(drive.wrong_steps, 0);
  EXPECT_LT(drive.end_error_m, 0.002 * drive.way_m);
}

}  // namespace
}  // namespace stereovox
