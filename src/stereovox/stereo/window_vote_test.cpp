#include "stereovox/stereo/window_vote.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "stereovox/stereo/judge_matches.h"

namespace stereovox {
namespace {

const cv::Size kSize(24, 16);
constexpr VoterParams kVoters = {
    .min_log_ratio = 10, .max_left_right = kStepsPerPixel, .min_share = 0.5};

Arms long_arms() {
  return arms_of(cv::Mat1b(kSize, 90), {.max_arm_px = 4}, portable_window_kernels(), 1);
}

// A surface at `disparity` that everybody is sure of.
MatchFeatures sure_surface(int disparity) {
  MatchFeatures features = features_of_size(kSize);
  features.disparity = static_cast<std::int16_t>(disparity);
  features.log_ratio = 60;
  features.left_right = 5;
  features.local_cost = 30;
  return features;
}

void doubt(MatchFeatures& features, cv::Rect where, int disparity) {
  features.disparity(where) = static_cast<std::int16_t>(disparity);
  features.log_ratio(where) = 0;
}

TEST(WindowVote, FillsADoubtfulHoleWithWhatSurroundsIt) {
  MatchFeatures features = sure_surface(-70);
  doubt(features, {10, 6, 3, 3}, 900);
  vote_in_windows(features, long_arms(), {}, kVoters, 1);
  EXPECT_EQ(cv::countNonZero(features.disparity != -70), 0);
  EXPECT_EQ(features.log_ratio(7, 11), 60 * 72 / 81) << "weighed by the share of the window";
  EXPECT_EQ(features.left_right(7, 11), 5);
  EXPECT_EQ(features.local_cost(7, 11), 30);
}

TEST(WindowVote, KeepsWhatItHasWhereTooFewAgree) {
  MatchFeatures features = sure_surface(320);
  doubt(features, {2, 2, 20, 12}, 900);
  vote_in_windows(features, long_arms(), {}, kVoters, 1);
  EXPECT_EQ(features.disparity(4, 4), 900) << "32 of 81 agree";
  EXPECT_EQ(features.log_ratio(4, 4), 0);
  EXPECT_EQ(features.disparity(8, 12), 900) << "nobody votes";
}

TEST(WindowVote, DoesNotTouchThoseWhoVote) {
  MatchFeatures features = sure_surface(320);
  features.disparity(7, 11) = 900;
  vote_in_windows(features, long_arms(), {}, kVoters, 1);
  EXPECT_EQ(features.disparity(7, 11), 900);
}

TEST(WindowVote, PixelsThatWereNotRecordedDoNotVote) {
  MatchFeatures features = sure_surface(320);
  doubt(features, {10, 6, 3, 3}, 900);
  vote_in_windows(features, long_arms(), cv::Mat1b(kSize, std::uint8_t{0}), kVoters, 1);
  EXPECT_EQ(features.disparity(7, 11), 900);
}

}  // namespace
}  // namespace stereovox
