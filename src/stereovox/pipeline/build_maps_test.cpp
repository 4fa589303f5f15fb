#include "stereovox/pipeline/build_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"

namespace stereovox {
namespace {

PipelineConfig config_for(int frames) {
  PipelineConfig config;
  config.dataset.max_frames = frames;
  config.threads = 2;
  config.occupancy.voxel_size_m = 0.1;
  return config;
}

std::unique_ptr<StereoSequence> demo(const PipelineConfig& config) {
  return open_sequence(std::string(STEREOVOX_SOURCE_DIR) + "/data/office_demo", config.dataset,
                       std::nullopt);
}

// The demo drive through a camera that is not as it should be.
class Changed : public StereoSequence {
 public:
  using Change = std::function<void(StereoFrame& frame)>;

  Changed(std::unique_ptr<StereoSequence> sequence, Change change)
      : sequence_(std::move(sequence)), change_(std::move(change)) {}
  const StereoRig& rig() const override { return sequence_->rig(); }
  const SequenceInfo& info() const override { return sequence_->info(); }
  const Trajectory& truth() const override { return sequence_->truth(); }
  std::span<const SkippedPair> skipped() const override { return sequence_->skipped(); }
  std::optional<StereoFrame> next() override {
    std::optional<StereoFrame> frame = sequence_->next();
    if (frame) change_(*frame);
    return frame;
  }

 private:
  std::unique_ptr<StereoSequence> sequence_;
  Change change_;
};

// Now and then it sees nothing.
Changed::Change blinks(std::set<int> dark) {
  return [dark = std::move(dark)](StereoFrame& frame) {
    if (!dark.contains(frame.index)) return;
    frame.left.pixels = cv::Mat1b(frame.left.pixels.size(), 2);
    frame.right.pixels = cv::Mat1b(frame.right.pixels.size(), 2);
  };
}

// From this frame on it shows the same again.
Changed::Change hangs(int last) {
  return [last, shown = StereoFrame{}](StereoFrame& frame) mutable {
    if (frame.index == last) shown = frame;
    if (frame.index <= last) return;
    frame.left.pixels = shown.left.pixels.clone();
    frame.right.pixels = shown.right.pixels.clone();
  };
}

BuildResult build(StereoSequence& sequence, const PipelineConfig& config,
                  const std::optional<Trajectory>& poses = std::nullopt) {
  return build_maps(sequence, config, poses, ProgressSink{});
}

TEST(BuildMaps, TracksAndMapsEachFrame) {
  const PipelineConfig config = config_for(8);
  const auto sequence = demo(config);
  const BuildResult result = build(*sequence, config);
  EXPECT_EQ(result.frames, 8);
  EXPECT_EQ(result.tracked, 8);
  ASSERT_EQ(result.segments.size(), 1U);
  EXPECT_EQ(result.segments[0].trajectory.size(), 8U);
  EXPECT_EQ(result.segments[0].map.frames_integrated, 8U);
  EXPECT_NEAR(result.segments[0].trajectory[0].T_world_camera.translation.z(), 0.62, 0.03)
      << "height of the camera from the ground plane";
}

TEST(BuildMaps, ALostFrameIsReportedWithItsTimeAndTouchesNoMap) {
  const PipelineConfig config = config_for(12);
  Changed sequence(demo(config), blinks({6, 7}));
  const BuildResult result = build(sequence, config);
  EXPECT_EQ(result.frames, 12);
  EXPECT_EQ(result.tracked, 10);
  ASSERT_EQ(result.lost.size(), 1U);
  EXPECT_EQ(result.lost[0].from_ns, 2'400'000'000);
  EXPECT_EQ(result.lost[0].to_ns, 2'800'000'000);
  EXPECT_EQ(result.lost[0].frames, 2);
  EXPECT_FALSE(result.lost[0].reason.empty());
  EXPECT_EQ(result.segments[0].map.frames_integrated, 10U)
      << "found back by recognising a keyframe";
}

TEST(BuildMaps, PicturesThatComeTwiceAreMappedOnce) {
  const PipelineConfig config = config_for(6);
  Changed sequence(demo(config), hangs(2));
  const BuildResult hung = build(sequence, config);
  EXPECT_EQ(hung.tracked, 6);
  EXPECT_EQ(hung.repeated, 3);
  ASSERT_EQ(hung.warnings.size(), 1U);
  EXPECT_EQ(hung.warnings[0], "3 of 6 frames show the same images as the one before: mapped once");
  int most = 0;
  hung.segments[0].map.for_each_block([&](const VoxelBlock& block) {
    for (const Voxel voxel : block.voxels) most = std::max<int>(most, voxel.observations);
  });
  EXPECT_EQ(most, 3);
}

TEST(BuildMaps, GivenPosesAreUsedAndFramesWithoutOneAreLost) {
  const PipelineConfig config = config_for(10);
  const auto sequence = demo(config);
  Trajectory poses = sequence->truth();
  poses.resize(7);
  const BuildResult result = build(*sequence, config, poses);
  EXPECT_EQ(result.tracked, 7);
  ASSERT_EQ(result.lost.size(), 1U);
  EXPECT_EQ(result.lost[0].reason, "no pose is given for this time");
  const Trajectory& used = result.segments[0].trajectory;
  EXPECT_LT((used[3].T_world_camera.translation - poses[3].T_world_camera.translation).norm(),
            1e-9);
  EXPECT_NEAR(result.segments[0].map.floor_z_m(), 0.0, 0.03);
}

TEST(BuildMaps, AGivenPoseBeyondWhatAMapHoldsLosesItsFrameAlone) {
  const PipelineConfig config = config_for(10);
  const auto sequence = demo(config);
  Trajectory poses = sequence->truth();
  poses[5].T_world_camera.translation.x() = 1e6;
  const BuildResult result = build(*sequence, config, poses);
  EXPECT_EQ(result.tracked, 9);
  ASSERT_EQ(result.lost.size(), 1U);
  EXPECT_TRUE(result.lost[0].reason.starts_with("the pose at (1e+06, ")) << result.lost[0].reason;
}

TEST(BuildMaps, StopsWhenAskedAndKeepsWhatThereIs) {
  const PipelineConfig config = config_for(12);
  const auto sequence = demo(config);
  int done = 0;
  ProgressSink sink;
  sink.frame_done = [&](const Progress& progress) { done = progress.frame; };
  sink.should_stop = [&] { return done == 3; };
  const BuildResult result = build_maps(*sequence, config, std::nullopt, sink);
  EXPECT_TRUE(result.was_stopped);
  EXPECT_EQ(result.frames, 3);
  EXPECT_EQ(result.segments[0].map.frames_integrated, 3U);
}

TEST(BuildMaps, MapsInASecondPassUnlessPosesAreNotRefined) {
  for (const bool refine : {true, false}) {
    PipelineConfig config = config_for(6);
    config.refine = refine;
    const auto sequence = demo(config);
    int tracking = 0, mapping = 0;
    std::size_t blocks_while_tracking = 0;
    ProgressSink sink;
    sink.frame_done = [&](const Progress& progress) {
      ++(progress.stage == RunStage::tracking ? tracking : mapping);
      if (progress.stage == RunStage::tracking) blocks_while_tracking = progress.voxel_blocks;
    };
    const BuildResult result = build_maps(*sequence, config, std::nullopt, sink);
    EXPECT_EQ(result.segments[0].map.frames_integrated, 6U);
    EXPECT_EQ(tracking, 6);
    EXPECT_EQ(mapping, refine ? 6 : 0);
    EXPECT_EQ(blocks_while_tracking > 0, !refine);
  }
}

TEST(BuildMaps, StoppedInTheSecondPassItKeepsWhatIsMapped) {
  const PipelineConfig config = config_for(8);
  const auto sequence = demo(config);
  int mapped = 0;
  ProgressSink sink;
  sink.frame_done = [&](const Progress& p) { mapped += p.stage == RunStage::mapping ? 1 : 0; };
  sink.should_stop = [&] { return mapped == 6; };
  const BuildResult result = build_maps(*sequence, config, std::nullopt, sink);
  EXPECT_TRUE(result.was_stopped);
  EXPECT_EQ(result.tracked, 8);
  EXPECT_EQ(result.segments[0].trajectory.size(), 6U);
}

TEST(BuildMaps, AnErrorOfTheFrontHalfReachesTheCaller) {
  const PipelineConfig config = config_for(12);
  Changed sequence(demo(config), [calls = 0](const StereoFrame&) mutable {
    if (++calls > 7) throw Error("left/000007.png: is cut off");
  });
  EXPECT_THROW(build(sequence, config), Error);
}

TEST(BuildMaps, ACameraThatSeesNothingLeavesAnEmptyMap) {
  const PipelineConfig config = config_for(4);
  Changed sequence(demo(config), blinks({0, 1, 2, 3}));
  const BuildResult result = build(sequence, config);
  EXPECT_EQ(result.tracked, 0);
  ASSERT_EQ(result.segments.size(), 1U);
  EXPECT_EQ(result.segments[0].map.known_voxel_count(), 0U);
}

}  // namespace
}  // namespace stereovox
