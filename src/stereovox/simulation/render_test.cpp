#include "stereovox/simulation/render.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/core/base.hpp>

#include "stereovox/simulation/rig.h"
#include "stereovox/simulation/room_for_test.h"

namespace stereovox {
namespace {

// Looks along x from (1, 2); the box's near face is 3 m away, the wall behind it 5 m.
class Render : public testing::Test {
 protected:
  Render() {
    params_.width_px = 160;
    params_.height_px = 120;
    params_.focal_px = 130;
    params_.pitch_deg = params_.shake_deg = 0;
    rig_ = rig_of(params_);
    T_world_left_ = camera_pose({{1, 2}, 0}, params_, 0, 1);
    T_world_right_ = T_world_left_ * inverse(rig_.T_right_left);
  }

  RectifiedCamera pair() const { return {rig_.left.pinhole, rig_.baseline_m()}; }

  World world_ = room_for_test();
  Scene scene_{world_, 0.0};
  RigParams params_;
  StereoRig rig_;
  SE3 T_world_left_, T_world_right_;
};

TEST_F(Render, DepthIsThatOfTheGeometry) {
  const cv::Mat1f depth = depth_of(scene_, PixelRays(rig_.left), T_world_left_, 1);
  EXPECT_NEAR(depth(60, 80), 3.0, 1e-4);   // the box
  EXPECT_NEAR(depth(30, 110), 5.0, 1e-4);  // the wall beside it
  // The floor, 0.62 m below the camera.
  EXPECT_NEAR(depth(118, 80), 0.62 / ((118 - 59.5) / 130), 1e-4);
}

TEST_F(Render, TheRightCameraSeesTheSamePointsShiftedByTheirDisparity) {
  const cv::Mat1f left = render(world_, scene_, PixelRays(rig_.left), T_world_left_, 1);
  const cv::Mat1f right = render(world_, scene_, PixelRays(rig_.right), T_world_right_, 1);
  const int disparity = 5;  // 130 * 0.12 / 3 = 5.2 on the box
  double same = 0, other = 0;
  for (int v = 50; v < 70; ++v)
    for (int u = 68; u < 92; ++u) {
      const float shifted = 0.8F * right(v, u - disparity) + 0.2F * right(v, u - disparity - 1);
      same += std::abs(left(v, u) - shifted);
      other += std::abs(left(v, u) - right(v, u));
    }
  EXPECT_LT(same, 0.35 * other);
}

TEST_F(Render, LightDependsOnShadows) {
  const cv::Mat1f with_box = render(world_, scene_, PixelRays(rig_.left), T_world_left_, 1);
  World empty = world_;
  std::erase_if(empty.solids, [](const Prism& solid) { return solid.name == "box"; });
  const Scene scene(empty, 0.0);
  const cv::Mat1f without = render(empty, scene, PixelRays(rig_.left), T_world_left_, 1);
  // The floor before the box is lit by fewer lamps.
  EXPECT_LT(cv::mean(with_box(cv::Rect(70, 93, 20, 3)))[0],
            0.95 * cv::mean(without(cv::Rect(70, 93, 20, 3)))[0]);
}

TEST_F(Render, IsTheSameForAnyNumberOfThreads) {
  const cv::Mat1f one = render(world_, scene_, PixelRays(rig_.left), T_world_left_, 1);
  for (const int threads : {2, 3, 8}) {
    const cv::Mat1f many = render(world_, scene_, PixelRays(rig_.left), T_world_left_, threads);
    EXPECT_EQ(cv::norm(one, many, cv::NORM_INF), 0.0) << threads;
  }
}

TEST_F(Render, PixelsHiddenFromTheRightCameraLieLeftOfANearerThing) {
  const PixelRays rays(rig_.left);
  const cv::Mat1f depth = depth_of(scene_, rays, T_world_left_, 1);
  const cv::Mat1b occluded = occluded_pixels(scene_, rays, depth, T_world_left_, pair(), 1);
  // Row through the box: the wall behind has disparity 3.12, the box 5.2, so that two pixels of the
  // wall are hidden left of the box. The side wall, disparity 4.8, begins outside the right image.
  int left_edge = 40;
  while (depth(60, left_edge) > 4) ++left_edge;
  EXPECT_EQ(occluded(60, left_edge - 1), 255);
  EXPECT_EQ(occluded(60, left_edge - 2), 255);
  EXPECT_EQ(occluded(60, left_edge - 4), 0);
  EXPECT_EQ(occluded(60, left_edge), 0);
  EXPECT_EQ(occluded(60, 2), 255);
  EXPECT_EQ(occluded(60, 8), 0);
  EXPECT_LT(cv::countNonZero(occluded.row(60)), 8);
}

TEST_F(Render, ALensWithDistortionSeesThePointsThatItsCalibrationSays) {
  params_.radial_1 = -0.2;
  const StereoRig distorted = rig_of(params_);
  const PixelRays rays(distorted.left);
  // At normalised (0.5, 0) the distorted place is 0.5 (1 - 0.2 * 0.25).
  const auto u = static_cast<float>(79.5 + 130 * 0.5 * (1 - 0.2 * 0.25));
  EXPECT_NEAR(rays.direction(u, 59.5F).x(), 0.5F, 2e-4F);
}

TEST_F(Render, PeopleMove) {
  world_ = room_for_test("people: [{path: [[2.5, 1], [2.5, 3]], speed_m_s: 1.0}]");
  const PixelRays rays(rig_.left);
  const cv::Mat1f before = depth_of(Scene(world_, 0.0), rays, T_world_left_, 1);
  const cv::Mat1f after = depth_of(Scene(world_, 1.0), rays, T_world_left_, 1);
  EXPECT_GT(before(50, 80), 2.5);
  EXPECT_NEAR(after(50, 80), 1.3, 0.02);  // at y = 2, radius 0.2
}

}  // namespace
}  // namespace stereovox
