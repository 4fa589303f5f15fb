#include "stereovox/io/disparity_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "stereovox/core/error.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/pfm.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

DisparityImage disparities(const cv::Mat1f& disparity_px) {
  return {disparity_px, cv::Mat1f::zeros(disparity_px.size())};
}

TEST(DisparityFile, IsReadAsWrittenInBothFormats) {
  const TemporaryFolder folder;
  const DisparityImage written = disparities((cv::Mat1f(1, 4) << 0.0F, 1.5F, 100.25F, 255.75F));
  for (const char* name : {"a.pfm", "a.png"}) {
    write_disparity(folder.path() / name, written);
    const DisparityImage read = read_disparity(folder.path() / name);
    EXPECT_EQ(cv::countNonZero(read.disparity_px != written.disparity_px), 0) << name;
    EXPECT_EQ(read.sigma_px.size(), read.disparity_px.size());
    EXPECT_EQ(cv::countNonZero(read.sigma_px), 0);
  }
}

TEST(DisparityFile, AsPngIsDisparityTimes256AndKeepsSmallMeasurements) {
  const TemporaryFolder folder;
  write_disparity(folder.path() / "a.png", disparities((cv::Mat1f(1, 3) << 0.0F, 0.001F, 2.0F)));
  const cv::Mat stored = read_image(folder.path() / "a.png");
  ASSERT_EQ(stored.type(), CV_16UC1);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 0), 0);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 1), 1);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 2), 512);
}

TEST(DisparityFile, ReadsWhatIsNotAMeasurementAsNone) {
  const TemporaryFolder folder;
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  write_pfm(folder.path() / "a.pfm", (cv::Mat1f(1, 5) << kInfinite, -kInfinite, kNan, -1.0F, 7.0F));
  const DisparityImage read = read_disparity(folder.path() / "a.pfm");
  EXPECT_EQ(cv::countNonZero(read.disparity_px), 1);
  EXPECT_EQ(read.disparity_px(0, 4), 7.0F);
}

TEST(DisparityFile, RefusesWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto complaint = [&](auto act) -> std::string {
    try {
      act();
    } catch (const Error& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return "";
  };
  write_png(folder.path() / "grey.png", cv::Mat1b::zeros(2, 2));
  EXPECT_EQ(complaint([&] { read_disparity(folder.path() / "grey.png"); }),
            "grey.png: has 1 channels of 8 bit, a disparity PNG has 1 of 16");
  const DisparityImage large = disparities(cv::Mat1f(1, 1, 300.0F));
  EXPECT_EQ(complaint([&] { write_disparity(folder.path() / "a.png", large); }),
            "a.png: disparity 300 px does not fit, the largest is 255.9961 px");
  EXPECT_EQ(complaint([&] { write_disparity(folder.path() / "a.tif", large); }),
            "a.tif: a disparity file ends with .pfm or .png");
}

}  // namespace
}  // namespace stereovox
