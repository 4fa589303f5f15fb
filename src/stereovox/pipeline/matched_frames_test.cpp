#include "stereovox/pipeline/matched_frames.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "stereovox/stereo/synthetic_pair_for_test.h"

namespace stereovox {
namespace {

// The same pair again and again, each time as bright as the next of `brightness` says.
class FadingSequence : public StereoSequence {
 public:
  explicit FadingSequence(std::vector<double> brightness) : brightness_(std::move(brightness)) {
    PinholeCamera& pinhole = rig_.left.pinhole;
    pinhole = {kSize.width, kSize.height, 200, 200, 80, 60};
    rig_.right.pinhole = pinhole;
    rig_.T_right_left.translation = {-0.1, 0, 0};
    rig_.is_rectified = true;
  }

  const StereoRig& rig() const override { return rig_; }
  const SequenceInfo& info() const override { return info_; }
  const Trajectory& truth() const override { return truth_; }
  std::span<const SkippedPair> skipped() const override { return {}; }
  std::optional<StereoFrame> next() override {
    if (next_ == brightness_.size()) return std::nullopt;
    StereoFrame frame{.stamp_ns = static_cast<std::int64_t>(next_),
                      .index = static_cast<int>(next_),
                      .name = "",
                      .left = {},
                      .right = {}};
    pair_.left.pixels.convertTo(frame.left.pixels, CV_8U, brightness_[next_]);
    pair_.right.pixels.convertTo(frame.right.pixels, CV_8U, brightness_[next_]);
    ++next_;
    return frame;
  }

 private:
  static inline const cv::Size kSize{160, 120};

  RectifiedPair pair_ = synthetic_pair(kSize, [](int, int) { return 12.0; });
  std::vector<double> brightness_;
  std::size_t next_ = 0;
  StereoRig rig_;
  SequenceInfo info_;
  Trajectory truth_;
};

TEST(MatchedFrames, DarkFramesHaveNoDisparities) {
  FadingSequence sequence({1.0, 0.03, 1.0});
  PipelineConfig config;
  config.threads = 1;
  const Rectifier rectifier(sequence.rig(), config.rectification);
  MatchedFrames frames(sequence, rectifier, config);
  std::vector<int> found;
  while (const auto frame = frames.next())
    found.push_back(cv::countNonZero(frame->disparity.disparity_px));
  ASSERT_EQ(found.size(), 3U);
  EXPECT_GT(found[0], 10'000);
  EXPECT_EQ(found[1], 0);
  EXPECT_EQ(found[2], found[0]);
}

}  // namespace
}  // namespace stereovox
