#include "stereovox/stereo/speckles.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stereovox {
namespace {

TEST(Speckles, IslandsThatAreTooSmallVanishAndOthersStay) {
  const cv::Mat1f before = (cv::Mat1f(4, 6) << 5, 5, 0, 9, 9, 0,  //
                            5, 0, 0, 0, 0, 0,                     //
                            5, 0, 7, 7, 0, 3,                     //
                            5, 5, 0, 0, 0, 0);
  const cv::Mat1f expected = (cv::Mat1f(4, 6) << 5, 5, 0, 0, 0, 0,  //
                              5, 0, 0, 0, 0, 0,                     //
                              5, 0, 0, 0, 0, 0,                     //
                              5, 5, 0, 0, 0, 0);
  cv::Mat1f found = before.clone();
  remove_speckles(found, 3, 1.0F);
  EXPECT_EQ(cv::countNonZero(found != expected), 0) << found;
}

TEST(Speckles, AStepThatIsTooLargeParts) {
  cv::Mat1f found = (cv::Mat1f(1, 6) << 5, 5.5, 6, 6.5, 9, 9.5);
  remove_speckles(found, 4, 0.5F);
  EXPECT_EQ(cv::countNonZero(found), 4);
  EXPECT_EQ(cv::countNonZero(found.colRange(4, 6)), 0);
}

TEST(Speckles, ArmsThatMeetBelowAreOneIsland) {
  cv::Mat1f found = (cv::Mat1f(3, 3) << 4, 0, 4,  //
                     4, 0, 4,                     //
                     4, 4, 4);
  remove_speckles(found, 7, 1.0F);
  EXPECT_EQ(cv::countNonZero(found), 7);
}

}  // namespace
}  // namespace stereovox
