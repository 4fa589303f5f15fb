#include "stereovox/io/pfm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

using namespace std::string_literals;

std::string complaint(const std::string& bytes) {
  const TemporaryFolder folder;
  try {
    read_pfm(folder.write("a.pfm", bytes));
  } catch (const Error& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

TEST(Pfm, IsReadAsWritten) {
  const TemporaryFolder folder;
  const cv::Mat1f image = (cv::Mat1f(2, 3) << 0.0F, 1.5F, -2.0F,  //
                           std::numeric_limits<float>::infinity(), 3.25F, 1e-20F);
  write_pfm(folder.path() / "a.pfm", image);
  const cv::Mat1f read = read_pfm(folder.path() / "a.pfm");
  ASSERT_EQ(read.size(), image.size());
  EXPECT_EQ(cv::countNonZero(read != image), 0);
}

TEST(Pfm, HoldsTheBottomRowFirstInEitherByteOrder) {
  const TemporaryFolder folder;
  const cv::Mat1f little =
      read_pfm(folder.write("little.pfm", "Pf\n1 2\n-1.0\n\x00\x00\x80\x3f\x00\x00\x00\x40"s));
  EXPECT_EQ(little(1, 0), 1.0F);
  EXPECT_EQ(little(0, 0), 2.0F);
  const cv::Mat1f big =
      read_pfm(folder.write("big.pfm", "Pf 1 2 0.003922 \x3f\x80\x00\x00\x40\x00\x00\x00"s));
  EXPECT_EQ(big(1, 0), 1.0F);
  EXPECT_EQ(big(0, 0), 2.0F);
}

TEST(Pfm, ThatIsNoneIsRefused) {
  EXPECT_EQ(complaint(""), "a.pfm: is not a one-channel PFM file");
  EXPECT_EQ(complaint("PF\n1 1\n-1\n12 bytes long"), "a.pfm: is not a one-channel PFM file");
  EXPECT_EQ(complaint("Pf\n2 2\n-1.0\n1234567890"),
            "a.pfm: is cut off (22 bytes); it should hold 2 x 2 pixels");
  EXPECT_EQ(complaint("Pf\n100000 100000\n-1.0\n"),
            "a.pfm: size is '100000' x '100000', at most 64 megapixels are read");
  EXPECT_EQ(complaint("Pf\n-3 x\n-1.0\n"),
            "a.pfm: size is '-3' x 'x', at most 64 megapixels are read");
  EXPECT_EQ(complaint("Pf\n1 1\n0\n1234"), "a.pfm: its scale is no number or zero");
  EXPECT_EQ(complaint("Pf\n1 1\nnan\n1234"), "a.pfm: its scale is no number or zero");
}

}  // namespace
}  // namespace stereovox
