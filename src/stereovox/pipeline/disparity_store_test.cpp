#include "stereovox/pipeline/disparity_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

DisparityImage random_image(cv::Size size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> disparity(-3.0F, 300.0F), sigma(0.05F, 2.0F);
  DisparityImage image{cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F)};
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; u += 1 + v % 3) {
      image.disparity_px(v, u) = disparity(random);
      image.sigma_px(v, u) = sigma(random);
    }
  return image;
}

TEST(DisparityStore, GivesBackWhatWasStoredInAnyOrder) {
  DisparityStore store(std::filesystem::temp_directory_path());
  std::vector<DisparityImage> images;
  for (const cv::Size size : {cv::Size(33, 17), cv::Size(1, 1), cv::Size(64, 48)})
    images.push_back(random_image(size, static_cast<unsigned>(size.width)));
  for (const DisparityImage& image : images) store.push_back(image);
  ASSERT_EQ(store.size(), 3U);
  for (const std::size_t i : {2U, 0U, 1U}) {
    const DisparityImage image = store.read(i);
    ASSERT_EQ(image.disparity_px.size(), images[i].disparity_px.size());
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u) {
        EXPECT_EQ(image.disparity_px(v, u), images[i].disparity_px(v, u));
        const float sigma_px = images[i].sigma_px(v, u);
        EXPECT_GE(image.sigma_px(v, u), sigma_px);
        EXPECT_LT(image.sigma_px(v, u), sigma_px + 1.0F / 256.0F);
      }
  }
}

TEST(DisparityStore, AFolderThatIsNotThereIsAnErrorWithItsName) {
  try {
    const DisparityStore store("no/such/folder");
    FAIL() << "no error";
  } catch (const ResourceError& error) {
    EXPECT_EQ(std::string(error.what()).find("frame store in no/such/folder: cannot be made"), 0U)
        << error.what();
  }
}

}  // namespace
}  // namespace stereovox
