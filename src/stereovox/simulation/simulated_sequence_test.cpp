#include "stereovox/simulation/simulated_sequence.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/pfm.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/simulation/room_for_test.h"
#include "stereovox/simulation/write_data_set.h"

namespace stereovox {
namespace {

SimulationParams small_images() {
  SimulationParams params;
  params.rig.width_px = 64;
  params.rig.height_px = 48;
  params.rig.focal_px = 50;
  return params;
}

std::shared_ptr<const Simulation> simulation(const SimulationParams& params = small_images(),
                                             int threads = 1) {
  return std::make_shared<Simulation>(room_for_test(), "main", params, "room.yaml", threads);
}

std::vector<StereoFrame> all_frames(StereoSequence& sequence) {
  std::vector<StereoFrame> frames;
  while (const std::optional<StereoFrame> frame = sequence.next()) frames.push_back(*frame);
  return frames;
}

double difference(const GrayImage& a, const GrayImage& b) {
  return cv::norm(a.pixels, b.pixels, cv::NORM_INF);
}

TEST(SimulatedSequence, DeliversTheWholeDrive) {
  const auto sequence = simulated_sequence(simulation(), {}, "room.yaml");
  const auto frames = all_frames(*sequence);  // 1.5 m at 0.5 m/s and 2 Hz
  EXPECT_THAT(frames.size(), testing::AllOf(testing::Ge(6U), testing::Le(8U)));
  EXPECT_EQ(sequence->info().pairs, static_cast<int>(frames.size()));
  EXPECT_EQ(frames[3].stamp_ns, 1'500'000'000);
  EXPECT_TRUE(sequence->rig().is_rectified);
  EXPECT_EQ(sequence->truth().size(), frames.size());
  EXPECT_NEAR(sequence->truth()[0].T_world_camera.translation.z(), 0.62, 1e-9);
}

TEST(SimulatedSequence, DeliversThePartThatIsAskedFor) {
  SequenceParams params;
  params.start_s = 1.0;
  params.duration_s = 1.0;
  params.frame_skip = 1;
  const auto frames = all_frames(*simulated_sequence(simulation(), params, "room.yaml"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].stamp_ns, 1'000'000'000);
  EXPECT_EQ(frames[1].stamp_ns, 2'000'000'000);
  params.start_s = 100.0;
  EXPECT_THROW(simulated_sequence(simulation(), params, "room.yaml"), UsageError);
}

TEST(SimulatedSequence, SameSeedSameImagesOnAnyNumberOfThreads) {
  const StereoFrame one = simulation()->frame(2), again = simulation(small_images(), 3)->frame(2);
  EXPECT_EQ(difference(one.left, again.left), 0);
  EXPECT_EQ(difference(one.right, again.right), 0);
  SimulationParams other = small_images();
  other.seed = 2;
  EXPECT_GT(difference(one.left, simulation(other)->frame(2).left), 0);
}

TEST(SimulatedSequence, ShiftMovesTheWorldAndTheRobotTogether) {
  SimulationParams params = small_images();
  params.jitter_m = 0;
  const SE3 still = simulation(params)->trajectory()[0].T_world_camera;
  const auto still_truth = simulation(params)->truth(0);
  params.shift_m = 0.5;
  const auto moved = simulation(params);
  const Eigen::Vector3d shift =
      moved->trajectory()[0].T_world_camera.translation - still.translation;
  EXPECT_GT(shift.head<2>().norm(), 0.01);
  EXPECT_NEAR((moved->world().min_m - room_for_test().min_m - shift.head<2>()).norm(), 0, 1e-9);
  EXPECT_LT(cv::norm(moved->truth(0).depth_m, still_truth.depth_m, cv::NORM_INF), 1e-4);
}

TEST(SimulatedSequence, TruthFitsTogether) {
  const auto s = simulation();
  const Simulation::Truth truth = s->truth(1);
  const double fb = 50 * 0.12;
  EXPECT_NEAR(truth.disparity_px(10, 30) * truth.depth_m(10, 30), fb, 1e-4);
  EXPECT_EQ(truth.occluded.size(), truth.depth_m.size());
}

TEST(SimulationParams, AreAllOnTheReferencePage) {
  const std::string page = read_file(STEREOVOX_SOURCE_DIR "/docs/simulation.md", 1 << 20);
  SimulationParams params;
  const ParameterList list = parameters_of(params);
  for (const Parameter& parameter : list.parameters())
    EXPECT_THAT(page, testing::HasSubstr("`" + parameter.path + "`"));
}

class WrittenDataSet : public testing::Test {
 protected:
  void expect_read_back(const SimulationParams& params, const std::string& layout) {
    const auto written = simulation(params);
    EXPECT_EQ(write_data_set(folder_, *written, {.truth_every = 3}),
              static_cast<int>(written->trajectory().size()));
    const auto read = open_sequence(folder_, {}, {});
    EXPECT_EQ(read->info().layout, layout);
    EXPECT_EQ(read->info().remarks, std::vector<std::string>{});
    EXPECT_NEAR(log(read->rig().T_right_left * inverse(written->rig().T_right_left)).norm(), 0,
                1e-6);
    EXPECT_EQ(read->rig().left.distortion, written->rig().left.distortion);
    const auto frames = all_frames(*read);
    ASSERT_EQ(frames.size(), written->trajectory().size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].stamp_ns, written->trajectory()[i].stamp_ns);
      const SE3 error =
          inverse(read->truth()[i].T_world_camera) * written->trajectory()[i].T_world_camera;
      EXPECT_LT(log(error).norm(), 1e-6);
    }
    EXPECT_EQ(difference(frames[2].right, written->frame(2).right), 0);
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();
};

TEST_F(WrittenDataSet, OfARectifiedRigIsReadBackAsPlain) {
  expect_read_back(small_images(), "plain");
  const auto truth = simulation()->truth(3);
  EXPECT_EQ(cv::norm(read_pfm(folder_ / "truth/depth/000003.pfm"), truth.depth_m, cv::NORM_INF), 0);
  EXPECT_EQ(
      cv::norm(read_pfm(folder_ / "truth/disparity/000003.pfm"), truth.disparity_px, cv::NORM_INF),
      0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "truth/depth/000001.pfm"));
}

TEST_F(WrittenDataSet, OfADistortedAndTurnedRigIsReadBackAsEuroc) {
  SimulationParams params = small_images();
  params.rig.radial_1 = -0.1;
  params.rig.toe_deg = 1.0;
  params.rig.roll_deg = 0.5;
  expect_read_back(params, "EuRoC/ASL");
}

TEST_F(WrittenDataSet, StoppedEarlyIsWholeAsFarAsItGoes) {
  int done = 0;
  EXPECT_EQ(write_data_set(folder_, *simulation(),
                           {.truth_every = 0,
                            .progress = [&](int frame, int) { done = frame; },
                            .should_stop = [&] { return done == 3; }}),
            3);
  EXPECT_EQ(open_sequence(folder_, {}, {})->info().pairs, 3);
}

}  // namespace
}  // namespace stereovox
