#include "stereovox/dataset/plain_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stereovox/dataset/open_sequence.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class PlainLayout : public testing::Test {
 protected:
  PlainLayout() { write_small_plain_set(folder_.path(), 12); }

  fs::path left(int i) const { return folder_.path() / "left" / image_name(i); }
  fs::path right(int i) const { return folder_.path() / "right" / image_name(i); }
  std::unique_ptr<StereoSequence> open() const { return open_sequence(folder_.path()); }
  std::string complaint() const { return complaint_about(folder_.path()); }

  TemporaryFolder folder_;
};

TEST_F(PlainLayout, DeliversItsPairsWithTimesAndTruth) {
  const auto sequence = open();
  EXPECT_EQ(sequence->info().layout, "plain");
  EXPECT_EQ(sequence->info().pairs, 12);
  ASSERT_EQ(sequence->truth().size(), 12U);
  EXPECT_EQ(sequence->truth()[11].stamp_ns, 1'100'000'000);
  EXPECT_NEAR(sequence->truth()[11].T_world_camera.translation.z(), 1.1, 1e-12);
  for (int i = 0; i < 12; ++i) {
    const std::optional<StereoFrame> frame = sequence->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stamp_ns, i * 100'000'000LL);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->name, image_name(i));
    EXPECT_EQ(frame->left.pixels(0, 0), i);
    EXPECT_EQ(frame->right.pixels(0, 0), 100 + i);
  }
  EXPECT_FALSE(sequence->next());
  EXPECT_TRUE(sequence->info().remarks.empty());
}

TEST_F(PlainLayout, TakesACalibrationOfAnotherFormUnderItsName) {
  folder_.write("calib.yaml",
                "M1: [30, 0, 15, 0, 30, 9, 0, 0, 1]\nD1: [0.1, 0, 0, 0]\n"
                "M2: [30, 0, 15, 0, 30, 9, 0, 0, 1]\nD2: [0, 0, 0, 0, 0]\n"
                "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nT: [-0.12, 0, 0]\n");
  const auto sequence = open();
  EXPECT_EQ(sequence->rig().left.pinhole.width, 32);
  EXPECT_EQ(sequence->rig().left.distortion.size(), 4U);
  EXPECT_FALSE(sequence->rig().is_rectified);
}

TEST_F(PlainLayout, DropsImagesWithoutAPartnerAndKeepsTheTimesOfTheRest) {
  fs::remove(left(3));
  fs::remove(right(5));
  const auto sequence = open();
  EXPECT_EQ(sequence->info().left_only, 1);
  EXPECT_EQ(sequence->info().right_only, 1);
  EXPECT_THAT(sequence->info().remarks,
              Contains("1 left images have no right image, first: left/000005.png"));
  EXPECT_THAT(sequence->info().remarks,
              Contains("1 right images have no left image, first: right/000003.png"));
  while (const std::optional<StereoFrame> frame = sequence->next()) {
    EXPECT_EQ(frame->stamp_ns, frame->left.pixels(0, 0) * 100'000'000LL);
    EXPECT_EQ(frame->right.pixels(0, 0), 100 + frame->left.pixels(0, 0));
    EXPECT_EQ(frame->index, frame->left.pixels(0, 0));
  }
}

TEST_F(PlainLayout, KeepsTheTimesAcrossAGapInTheNumbering) {
  for (const int i : {0, 4, 5, 6}) {
    fs::remove(left(i));
    fs::remove(right(i));
  }
  const auto sequence = open();
  EXPECT_EQ(sequence->info().gaps, 1);
  EXPECT_THAT(sequence->info().remarks,
              Contains("the numbering of the left images skips at 1 places"));
  int frames = 0;
  for (; const std::optional<StereoFrame> frame = sequence->next(); ++frames)
    EXPECT_EQ(frame->stamp_ns, frame->left.pixels(0, 0) * 100'000'000LL);
  EXPECT_EQ(frames, 8);
}

TEST_F(PlainLayout, KeepsTheTimesOfNamesThatAreNoNumbersWhenALeftImageIsLost) {
  for (int i = 0; i < 12; ++i)
    for (const fs::path& image : {left(i), right(i)})
      fs::rename(image, image.parent_path() / ("view_" + image.filename().string()));
  fs::remove(folder_.path() / "left" / "view_000003.png");
  const auto sequence = open();
  int frames = 0;
  for (; const std::optional<StereoFrame> frame = sequence->next(); ++frames)
    EXPECT_EQ(frame->stamp_ns, frame->left.pixels(0, 0) * 100'000'000LL);
  EXPECT_EQ(frames, 11);
}

TEST_F(PlainLayout, RefusesTimesThatFitNoNumberOfImages) {
  write_text(folder_.path() / "times.txt", "0\n0.1\n0.2\n");
  EXPECT_EQ(complaint(),
            (folder_.path() / "times.txt").string() + ": has 3 times for 12 left images");
}

TEST_F(PlainLayout, DropsAFrameThatGoesBackInTimeOrRepeatsATime) {
  write_text(folder_.path() / "times.txt",
             "0\n0.1\n0.2\n0.15\n0.4\n0.5\n0.5\n0.7\n0.8\n0.9\n1.0\n1.1\n");
  const auto sequence = open();
  EXPECT_EQ(sequence->info().duplicates, 1);
  EXPECT_THAT(sequence->info().remarks,
              Contains("1 images go back in time and are left out, first: left/000003.png"));
  EXPECT_THAT(left_marks(*sequence), ElementsAre(0, 1, 2, 4, 5, 7, 8, 9, 10, 11));
}

TEST_F(PlainLayout, RemarksOnAJumpInTimeAndOnEqualTimes) {
  write_text(folder_.path() / "times.txt",
             "0\n0.1\n0.2\n0.3\n0.4\n0.5\n3600.6\n3600.7\n3600.8\n3600.9\n3601.0\n3601.1\n");
  EXPECT_THAT(open()->info().remarks,
              ElementsAre("1 jumps in time, the first of 3600.100 s (usual: 0.100 s)"));
  write_text(folder_.path() / "times.txt", "0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n");
  const auto sequence = open();
  EXPECT_EQ(sequence->info().remarks.size(), 1U);
  sequence->next();
  EXPECT_EQ(sequence->next()->stamp_ns, 100'000'000);
}

TEST_F(PlainLayout, NamesWhatIsMissing) {
  fs::rename(folder_.path() / "poses.txt", folder_.path() / "gone.txt");
  EXPECT_TRUE(open()->truth().empty());
  fs::rename(folder_.path() / "calib.yaml", folder_.path() / "gone.yaml");
  EXPECT_EQ(complaint(), (folder_.path() / "calib.yaml").string() +
                             ": cannot be opened (No such file or directory)");
  fs::remove_all(folder_.path() / "right");
  EXPECT_EQ(complaint(),
            (folder_.path() / "right").string() + ": no right images (PNG, PGM, JPEG, BMP, TIFF)");
  fs::remove_all(folder_.path() / "left");
  fs::create_directory(folder_.path() / "left");
  EXPECT_EQ(complaint(),
            (folder_.path() / "left").string() + ": no left images (PNG, PGM, JPEG, BMP, TIFF)");
}

TEST_F(PlainLayout, RefusesSidesWhoseNamesDoNotMatch) {
  for (int i = 0; i < 12; ++i)
    fs::rename(right(i), folder_.path() / "right" / ("r" + image_name(i)));
  EXPECT_THAT(complaint(), HasSubstr("no image has a partner of the same name in"));
}

TEST_F(PlainLayout, AcceptsLinksAndMixedFormats) {
  fs::rename(left(2), folder_.path() / "elsewhere.png");
  fs::create_symlink(folder_.path() / "elsewhere.png", left(2));
  fs::create_symlink(folder_.path(), folder_.path() / "link");
  EXPECT_EQ(left_marks(*open_sequence(folder_.path() / "link")).size(), 12U);
}

}  // namespace
}  // namespace stereovox
