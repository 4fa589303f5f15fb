#include "stereovox/baselines/pseudo_scan.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "stereovox/core/angles.h"
#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kCameraHeight_m = 0.6;
constexpr double kSigma_px = 0.25;

// 640 x 480, 62.6 degrees wide, its centre in the middle of the image.
RectifiedCamera test_camera() {
  return {.pinhole = {.width = 640,
                      .height = 480,
                      .fx_px = 525.0,
                      .fy_px = 525.0,
                      .cx_px = 319.5,
                      .cy_px = 239.5},
          .baseline_m = 0.12};
}

// A camera that looks along the world's x axis, then pitched down and rolled.
SE3 pose(double pitch_rad = 0.0, double roll_rad = 0.0, double yaw_rad = 0.0) {
  Eigen::Matrix3d R_base_camera;
  R_base_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()) *
                                      Eigen::Quaterniond(R_base_camera);
  return {rotation, {1.0, 2.0, kCameraHeight_m}};
}

// Distance along a ray to what it meets first, or nothing (infinity).
using Scene = std::function<double(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray)>;

constexpr double kNothing = std::numeric_limits<double>::infinity();

double floor_distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  return ray.z() < 0.0 ? -origin.z() / ray.z() : kNothing;
}

// A vertical wall across the x axis, between two heights and two sides.
Scene wall(double x_m, double bottom_m, double top_m, double right_m = -100, double left_m = 100) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    const double t = (x_m - origin.x()) / ray.x();
    const Eigen::Vector3d p = origin + t * ray;
    const bool is_hit =
        ray.x() > 0.0 && p.z() >= bottom_m && p.z() <= top_m && p.y() >= right_m && p.y() <= left_m;
    return is_hit ? t : kNothing;
  };
}

DisparityImage seen(const std::vector<Scene>& scene, const SE3& T_world_camera) {
  const RectifiedCamera camera = test_camera();
  const PinholeCamera& pinhole = camera.pinhole;
  DisparityImage image{cv::Mat1f(pinhole.height, pinhole.width, 0.0F),
                       cv::Mat1f(pinhole.height, pinhole.width, 0.0F)};
  for (int v = 0; v < pinhole.height; ++v)
    for (int u = 0; u < pinhole.width; ++u) {
      const Eigen::Vector3d ray_camera((u - pinhole.cx_px) / pinhole.fx_px,
                                       (v - pinhole.cy_px) / pinhole.fy_px, 1.0);
      double depth_m = kNothing;
      for (const Scene& part : scene)
        depth_m = std::min(depth_m,
                           part(T_world_camera.translation, T_world_camera.rotation * ray_camera));
      if (depth_m == kNothing) continue;
      image.disparity_px(v, u) = static_cast<float>(camera.disparity_px(depth_m));
      image.sigma_px(v, u) = kSigma_px;
    }
  return image;
}

PseudoScan scan_of(const DisparityImage& image, const SE3& T_world_camera) {
  return pseudo_scan(image, test_camera(), T_world_camera, 0.0, 7, {});
}

const Beam& beam_at(const PseudoScan& scan, double bearing_deg) {
  return *std::ranges::min_element(scan.beams, {}, [&](const Beam& beam) {
    return std::abs(beam.bearing_rad - bearing_deg * kDegree_rad);
  });
}

TEST(PseudoScan, HasABinForEachHalfDegreeOfTheView) {
  const PseudoScan scan = scan_of(seen({wall(4.0, 0, 3)}, pose()), pose());
  ASSERT_EQ(scan.beams.size(), 125U);
  EXPECT_EQ(scan.stamp_ns, 7);
  EXPECT_EQ(scan.position_m, Eigen::Vector2d(1.0, 2.0));
  EXPECT_NEAR(scan.heading_rad, 0.0, 1e-12);
  EXPECT_NEAR(scan.beams.front().bearing_rad, -31.0 * kDegree_rad, 1e-9);
  EXPECT_NEAR(scan.beams.back().bearing_rad, 31.0 * kDegree_rad, 1e-9);
}

TEST(PseudoScan, WallIsReadAtItsHorizontalRangeInEveryBin) {
  const PseudoScan scan = scan_of(seen({wall(4.0, 0, 3), floor_distance}, pose()), pose());
  for (const Beam& beam : scan.beams) {
    ASSERT_TRUE(beam.has_range);
    EXPECT_NEAR(beam.range_m, 3.0 / std::cos(beam.bearing_rad), 0.02);
  }
}

TEST(PseudoScan, PitchRollAndHeadingOfTheCameraDoNotMatter) {
  const SE3 tilted = pose(15 * kDegree_rad, 3 * kDegree_rad, -10 * kDegree_rad);
  const PseudoScan scan = scan_of(seen({wall(4.0, 0, 3), floor_distance}, tilted), tilted);
  EXPECT_NEAR(scan.heading_rad, -10 * kDegree_rad, 1e-9);
  for (const double bearing_deg : {-20.0, 0.0, 20.0}) {
    const Beam& beam = beam_at(scan, bearing_deg);
    ASSERT_TRUE(beam.has_range);
    EXPECT_NEAR(beam.range_m, 3.0 / std::cos(beam.bearing_rad + scan.heading_rad), 0.02);
  }
}

TEST(PseudoScan, SigmaIsThatOfTheRange) {
  const PseudoScan scan = scan_of(seen({wall(4.0, 0, 3)}, pose()), pose());
  const double on_axis_m = kSigma_px * 3.0 * 3.0 / (525.0 * 0.12);
  EXPECT_NEAR(beam_at(scan, 0.0).sigma_m, on_axis_m, 0.002);
}

TEST(PseudoScan, OnlyTheHeightBandIsRead) {
  const Scene lintel = wall(3.7, 1.6, 3.0);
  const Scene doorstep = wall(2.5, 0.0, 0.1);
  const PseudoScan scan = scan_of(seen({lintel, doorstep, wall(4.0, 0, 3)}, pose()), pose());
  EXPECT_NEAR(beam_at(scan, 0.0).range_m, 3.0, 0.02);
}

TEST(PseudoScan, NearestOfTwoThingsInABinIsRead) {
  const PseudoScan scan =
      scan_of(seen({wall(3.0, 0, 0.5, 1.8, 2.2), wall(4.0, 0, 3)}, pose()), pose());
  EXPECT_NEAR(beam_at(scan, 0.0).range_m, 2.0, 0.02);
  EXPECT_NEAR(beam_at(scan, 15.0).range_m, 3.0 / std::cos(15.0 * kDegree_rad), 0.03);
}

TEST(PseudoScan, FewerThanFivePointsAreNoReading) {
  DisparityImage image = seen({wall(4.0, 0, 3)}, pose());
  cv::Mat1f(image.disparity_px, cv::Rect(318, 200, 2, 2)) = 42.0F;  // 1.5 m, in one bin
  PseudoScanParams params;
  params.speckle_size_px = 0;
  const auto range_m = [&] {
    return beam_at(pseudo_scan(image, test_camera(), pose(), 0.0, 0, params), 0.0).range_m;
  };
  EXPECT_NEAR(range_m(), 3.0, 0.02);
  cv::Mat1f(image.disparity_px, cv::Rect(318, 200, 2, 3)) = 42.0F;
  EXPECT_NEAR(range_m(), 1.5, 0.02);
}

TEST(PseudoScan, SpecklesAreDropped) {
  DisparityImage image = seen({wall(4.0, 0, 3)}, pose());
  cv::Mat1f(image.disparity_px, cv::Rect(315, 200, 9, 11)) = 42.0F;  // 99 px
  EXPECT_NEAR(beam_at(scan_of(image, pose()), 0.0).range_m, 3.0, 0.02);
  image = seen({wall(4.0, 0, 3)}, pose());
  cv::Mat1f(image.disparity_px, cv::Rect(315, 200, 10, 10)) = 42.0F;  // 100 px
  EXPECT_NEAR(beam_at(scan_of(image, pose()), 0.0).range_m, 1.5, 0.02);
}

TEST(PseudoScan, MissingMatchesSayNothing) {
  const PseudoScan scan = scan_of(seen({}, pose()), pose());
  ASSERT_EQ(scan.beams.size(), 125U);
  for (const Beam& beam : scan.beams) {
    EXPECT_FALSE(beam.has_range);
    EXPECT_EQ(beam.free_range_m, 0.0);
  }
}

TEST(PseudoScan, FloorShowsFreeSpaceAsFarAsItIsSeen) {
  const Scene floor_to_3_m = [](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    const double t = floor_distance(origin, ray);
    return t * ray.x() < 3.0 ? t : kNothing;
  };
  const PseudoScan scan = scan_of(seen({floor_to_3_m}, pose()), pose());
  const Beam& beam = beam_at(scan, 0.0);
  EXPECT_FALSE(beam.has_range);
  EXPECT_NEAR(beam.free_range_m, 3.0 - 3 * kSigma_px * 3.0 * 3.0 / 63.0, 0.05);
}

TEST(PseudoScan, BackgroundShowsFreeSpaceUpToTheCap) {
  const PseudoScan scan = scan_of(seen({wall(9.0, 0, 3)}, pose()), pose());
  const Beam& beam = beam_at(scan, 0.0);
  EXPECT_FALSE(beam.has_range);
  EXPECT_NEAR(beam.free_range_m, 5.25, 1e-6);
}

TEST(PseudoScan, BackgroundAboveTheBandShowsFreeSpaceUntilTheSightLineLeavesTheBand) {
  const PseudoScan scan = scan_of(seen({wall(9.0, 3.0, 3.4)}, pose()), pose());
  // 0.9 m of the 2.4 m that the lower edge lies above the camera.
  const double sigma_m = kSigma_px * 8.0 * 8.0 / 63.0;
  EXPECT_NEAR(beam_at(scan, 0.0).free_range_m, (8.0 - 3 * sigma_m) * 0.9 / 2.4, 0.05);
}

TEST(PseudoScan, RangeSigmaIsThatOfTheVectors) {
  std::ifstream file(STEREOVOX_SOURCE_DIR "/src/stereovox/occupancy/testdata/vectors.json");
  const auto rows = nlohmann::json::parse(file).at("triangulation_and_range_sigma");
  RectifiedCamera camera = test_camera();
  camera.pinhole.cx_px = camera.pinhole.cy_px = 0.0;
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_NEAR(range_sigma_m(camera, row.at("u"), row.at("v"), row.at("d"), 0.5, 0.5),
                row.at("sigma_range_corrected").get<double>(), 1e-7);
  }
}

TEST(PseudoScan, UpsideDownHeightBandIsRefused) {
  PseudoScanParams params;
  params.min_height_m = 2.0;
  EXPECT_THROW(pseudo_scan(seen({}, pose()), test_camera(), pose(), 0.0, 0, params), UsageError);
}

}  // namespace
}  // namespace stereovox
