#include "stereovox/odometry/direct_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stereovox/odometry/direct_fit_reference.h"
#include "stereovox/odometry/image_levels.h"
#include "stereovox/odometry/room_for_test.h"

namespace stereovox {
namespace {

struct HalvedShot {
  SurfaceLevel surfaces;
  RectifiedCamera camera;
};

HalvedShot halved_shot(const SE3& T_world_camera, int frame) {
  const Shot shot = shot_from(T_world_camera, frame);
  PairLevel images = halved(PairLevel{shot.pair, shot.disparity});
  // Holes, and columns that are no multiple of a vector.
  images.disparity.disparity_px(cv::Rect(40, 20, 31, 17)) = 0.0F;
  return {{detail_of(images.pair), images.disparity.disparity_px}, halved(kCamera)};
}

SE3 moved(double metres, double radians) {
  Vector6d motion;
  motion << metres, -0.4 * metres, 1.5 * metres, 0.3 * radians, radians, -0.2 * radians;
  return exp(motion);
}

void expect_equal(const EyeFit& fast, const EyeFit& plain) {
  // Rounding may put a pixel on the border in or out of view.
  EXPECT_NEAR(fast.seen, plain.seen, 2);
  EXPECT_NEAR(fast.correlation, plain.correlation, 1e-4);
  EXPECT_NEAR(fast.sigma, plain.sigma, 2e-3);
}

void expect_equal(const DirectFit& fast, const DirectFit& plain) {
  EXPECT_EQ(fast.known, plain.known);
  expect_equal(fast.left, plain.left);
  expect_equal(fast.right, plain.right);
  EXPECT_LT((fast.H - plain.H).norm(), 1e-3 * plain.H.norm());
  EXPECT_LT((fast.g - plain.g).norm(), 1e-3 * plain.g.norm() + 1e-3 * std::sqrt(plain.H.norm()));
}

TEST(DirectFitter, GivesWhatThePlainFormGives) {
  const HalvedShot reference = halved_shot(SE3{}, 1), current = halved_shot(moved(0.05, 0.02), 2);
  const DirectPair pair{reference.camera, reference.surfaces, current.surfaces.detail};
  DirectFitter fitter(pair);
  // Not at rest, where whole rows lie on the border of what is in view.
  for (const double step : {0.003, 0.05, -0.1, 0.5, 1.0}) {
    const SE3 place = moved(step, 0.4 * step);
    expect_equal(fitter.at(place), direct_fit_reference(pair, place));
  }
}

TEST(DirectFitter, NothingInViewGivesNoEquations) {
  const HalvedShot reference = halved_shot(SE3{}, 1);
  const DirectPair pair{reference.camera, reference.surfaces, reference.surfaces.detail};
  const DirectFit fit = DirectFitter(pair).at(moved(0.0, 3.1));
  EXPECT_EQ(fit.left.seen, 0);
  EXPECT_EQ(fit.H.norm(), 0.0);
  EXPECT_EQ(fit.overlap(), 0.0);
}

TEST(DirectFitter, RemembersNothingOfAnEarlierPlace) {
  const HalvedShot reference = halved_shot(SE3{}, 1), current = halved_shot(moved(0.05, 0.02), 2);
  const DirectPair pair{reference.camera, reference.surfaces, current.surfaces.detail};
  DirectFitter used(pair);
  used.at(SE3{});
  EXPECT_EQ(used.at(moved(0.5, 0.2)).H, DirectFitter(pair).at(moved(0.5, 0.2)).H);
}

}  // namespace
}  // namespace stereovox
