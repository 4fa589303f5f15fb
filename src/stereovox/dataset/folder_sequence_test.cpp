#include "stereovox/dataset/folder_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"
#include "stereovox/dataset/small_data_set.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class FolderSequence : public testing::Test {
 protected:
  FolderSequence() { write_small_plain_set(folder_.path(), 20); }

  fs::path image(const char* side, int i) const { return folder_.path() / side / image_name(i); }
  void cut_in_half(const fs::path& path) const { fs::resize_file(path, fs::file_size(path) / 2); }
  std::vector<int> marks(const SequenceParams& params) const {
    return left_marks(*open_sequence(folder_.path(), params));
  }

  TemporaryFolder folder_;
  SequenceParams forgiving_ = [] {
    SequenceParams params;
    params.max_skipped_percent = 50.0;
    return params;
  }();
};

TEST_F(FolderSequence, SkipsAnUnusablePairAndSaysWhy) {
  cut_in_half(image("left", 3));
  cut_in_half(image("right", 4));
  fs::resize_file(image("right", 5), 0);
  write_small_image(image("left", 6), 6, kSmallWidth - 1, kSmallHeight);
  const auto sequence = open_sequence(folder_.path(), forgiving_);
  EXPECT_THAT(left_marks(*sequence),
              ElementsAre(0, 1, 2, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19));
  ASSERT_EQ(sequence->skipped().size(), 4U);
  EXPECT_EQ(sequence->skipped()[0].name, "000003.png");
  EXPECT_THAT(sequence->skipped()[0].reason, HasSubstr("left/000003.png: is cut off ("));
  EXPECT_THAT(sequence->skipped()[1].reason, HasSubstr("right/000004.png: is cut off ("));
  EXPECT_THAT(sequence->skipped()[2].reason, EndsWith("right/000005.png: is empty"));
  EXPECT_THAT(sequence->skipped()[3].reason,
              EndsWith("left/000006.png: size is 31 x 20, the calibration says 32 x 20"));
}

TEST_F(FolderSequence, SkipsACutOffJpegThatADecoderWouldCompleteInGrey) {
  fs::remove(image("left", 3));
  cv::Mat1b noise(kSmallHeight, kSmallWidth);
  cv::randu(noise, 0, 255);
  const fs::path jpeg = folder_.path() / "left" / "000003.jpg";
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", noise, bytes);
  write_text(jpeg, std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(marks(forgiving_).size(), 20U);
  cut_in_half(jpeg);
  const auto sequence = open_sequence(folder_.path(), forgiving_);
  EXPECT_EQ(left_marks(*sequence).size(), 19U);
  EXPECT_THAT(sequence->skipped()[0].reason, HasSubstr("000003.jpg: is cut off ("));
}

TEST_F(FolderSequence, GivesUpWhenTooManyPairsAreUnusable) {
  cut_in_half(image("left", 3));
  EXPECT_EQ(complaint_about(folder_.path()), "");  // 1 of 20 is 5 %
  cut_in_half(image("left", 9));
  EXPECT_THAT(complaint_about(folder_.path()),
              HasSubstr("2 of 20 pairs cannot be used, at most 1 may be (5 %); first: "));
  EXPECT_THAT(complaint_about(folder_.path()), HasSubstr("left/000003.png: is cut off"));
}

TEST_F(FolderSequence, ForgivesOneBadPairOfAFewButNotAll) {
  SequenceParams params;
  params.max_frames = 3;
  cut_in_half(image("left", 1));
  EXPECT_EQ(complaint_about(folder_.path(), params), "");
  params.max_skipped_percent = 0.0;
  EXPECT_THAT(complaint_about(folder_.path(), params), HasSubstr("1 of 3 pairs cannot be used"));
  params.max_skipped_percent = 100.0;
  cut_in_half(image("left", 0));
  cut_in_half(image("left", 2));
  EXPECT_THAT(complaint_about(folder_.path(), params), HasSubstr("3 of 3 pairs cannot be used"));
}

TEST_F(FolderSequence, RefusesACalibrationOfAnotherResolutionAtOnce) {
  std::string text = kSmallCalibration;
  write_text(folder_.path() / "calib.yaml", text.replace(0, 20, "width: 64\nheight: 40"));
  EXPECT_THAT(
      complaint_about(folder_.path(), forgiving_),
      EndsWith("left/000000.png: size is 32 x 20, the calibration says 64 x 40, 2 times the "
               "size; is it of another resolution?"));
}

TEST_F(FolderSequence, StatesOnceHowImagesAreConverted) {
  for (const int i : {2, 3}) {
    cv::Mat deep;
    read_image(image("left", i)).convertTo(deep, CV_16U, 257.0);
    write_png(image("left", i), deep);
  }
  const auto sequence = open_sequence(folder_.path());
  EXPECT_EQ(left_marks(*sequence).size(), 20U);
  EXPECT_THAT(sequence->info().remarks,
              ElementsAre("images are converted: 16 bit, scaled to 8; first: 000002.png"));
}

TEST_F(FolderSequence, DeliversTheChosenPart) {
  SequenceParams params;
  params.start_s = 0.5;
  params.duration_s = 1.0;
  EXPECT_THAT(marks(params), ElementsAre(5, 6, 7, 8, 9, 10, 11, 12, 13, 14));
  params.frame_skip = 2;
  EXPECT_THAT(marks(params), ElementsAre(5, 8, 11, 14));
  params.max_frames = 3;
  EXPECT_THAT(marks(params), ElementsAre(5, 8, 11));
  EXPECT_EQ(open_sequence(folder_.path(), params)->info().pairs, 3);
  EXPECT_EQ(open_sequence(folder_.path(), params)->next()->index, 5);
  params.start_s = 2.0;
  EXPECT_THROW(open_sequence(folder_.path(), params), UsageError);
  EXPECT_EQ(complaint_about(folder_.path(), params),
            "no pair from 2 s on for 1 s; the sequence is 1.900 s long");
}

TEST_F(FolderSequence, RemarksOnAnUnusualBaseline) {
  std::string text = kSmallCalibration;
  write_text(folder_.path() / "calib.yaml", text.replace(text.find("0.12"), 4, "5.00"));
  EXPECT_THAT(open_sequence(folder_.path())->info().remarks,
              Contains(HasSubstr("baseline of 5 m is unusual")));
}

}  // namespace
}  // namespace stereovox
