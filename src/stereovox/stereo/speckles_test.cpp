#include "stereovox/stereo/speckles.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace stereovox {
namespace {

cv::Mat1b all(const cv::Mat1s& image) { return cv::Mat1b(image.size(), 1); }

TEST(Speckles, IslandsThatAreTooSmallVanishAndOthersStay) {
  const cv::Mat1s before = (cv::Mat1s(4, 6) << 5, 5, 0, 9, 9, 0,  //
                            5, 0, 0, 0, 0, 0,                     //
                            5, 0, 7, 7, 0, 3,                     //
                            5, 5, 0, 0, 0, 0);
  const cv::Mat1s expected = (cv::Mat1s(4, 6) << 5, 5, 0, 0, 0, 0,  //
                              5, 0, 0, 0, 0, 0,                     //
                              5, 0, 0, 0, 0, 0,                     //
                              5, 5, 0, 0, 0, 0);
  cv::Mat1s found = before.clone();
  remove_speckles(found, all(found), 3, 1);
  EXPECT_EQ(cv::countNonZero(found != expected), 0) << found;
}

TEST(Speckles, AStepThatIsTooLargeParts) {
  cv::Mat1s found = (cv::Mat1s(1, 6) << 50, 55, 60, 65, 90, 95);
  remove_speckles(found, all(found), 4, 5);
  EXPECT_EQ(cv::countNonZero(found), 4);
  EXPECT_EQ(cv::countNonZero(found.colRange(4, 6)), 0);
}

TEST(Speckles, ArmsThatMeetBelowAreOneIsland) {
  cv::Mat1s found = (cv::Mat1s(3, 3) << 4, 0, 4,  //
                     4, 0, 4,                     //
                     4, 4, 4);
  remove_speckles(found, all(found), 7, 1);
  EXPECT_EQ(cv::countNonZero(found), 7);
}

TEST(Speckles, AnIslandStaysForItsPixelsThatCount) {
  cv::Mat1s found = (cv::Mat1s(1, 7) << 5, 5, 5, 0, 9, 9, 9);
  remove_speckles(found, (cv::Mat1b(1, 7) << 1, 0, 0, 1, 1, 0, 1), 2, 1);
  EXPECT_EQ(cv::countNonZero(found.colRange(0, 3)), 0);
  EXPECT_EQ(cv::countNonZero(found.colRange(4, 7)), 3);
}

}  // namespace
}  // namespace stereovox
