// Random images of random sizes, searched in random ranges: whatever comes, the contract of
// matcher.h holds.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

#include "stereovox/stereo/adaptive_window.h"
#include "stereovox/stereo/census_sgm.h"

namespace stereovox {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  int between(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }

 private:
  std::mt19937 random_;
};

// Constant, noise of some grey values, or noise in blocks.
cv::Mat1b random_image(cv::Size size, Dice& dice) {
  const int levels = dice.between(1, 4) * dice.between(1, 64), block_px = dice.between(1, 5);
  cv::Mat1b image(size);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u)
      image(v, u) = u % block_px == 0 ? static_cast<std::uint8_t>(dice.between(0, levels - 1))
                                      : image(v, u - 1);
  return image;
}

RectifiedPair random_pair(Dice& dice) {
  const cv::Size size(dice.between(1, 90), dice.between(1, 260));
  RectifiedPair pair;
  pair.left.pixels = random_image(size, dice);
  pair.right.pixels = dice.between(0, 1) == 0 ? pair.left.pixels.clone() : random_image(size, dice);
  if (dice.between(0, 2) == 0) pair.valid_left = random_image(size, dice);
  if (dice.between(0, 2) == 0) pair.valid_right = random_image(size, dice);
  return pair;
}

CensusSearch random_search(Dice& dice) {
  CensusSearch search;
  search.min_disparity_px = dice.between(-512, 512) / dice.between(1, 30);
  search.disparity_range_px = dice.between(1, kMaxCandidates);
  search.min_confidence = 0.01 * dice.between(0, 60);
  search.left_right_tolerance_px = dice.between(0, 64);
  search.speckle_size_px = dice.between(0, 3);
  search.island_confidence = 0;
  return search;
}

CensusSgmParams random_sgm(Dice& dice) {
  CensusSgmParams params{.search = random_search(dice)};
  params.smoothness_small = dice.between(0, 100);
  params.smoothness_nearer = dice.between(0, 100);
  params.smoothness_large = dice.between(params.smoothness_small + 1, 220);
  return params;
}

AdaptiveWindowParams random_windows(Dice& dice) {
  AdaptiveWindowParams params{.search = random_search(dice)};
  params.support = static_cast<WindowSupport>(dice.between(0, 3));
  params.window_half_px = dice.between(1, kMaxWindowHalf_px);
  params.max_arm_px = dice.between(1, kMaxArm_px);
  params.arm_contrast_gray = dice.between(0, 255) / dice.between(1, 20);
  params.min_vote_share = 0.01 * dice.between(0, 100);
  return params;
}

void expect_contract(const DisparityImage& found, const CensusSearch& search) {
  for (int v = 0; v < found.height(); ++v)
    for (int u = 0; u < found.width(); ++u) {
      const float disparity_px = found.disparity_px(v, u);
      ASSERT_EQ(disparity_px > 0, found.sigma_px(v, u) > 0);
      ASSERT_EQ(disparity_px > 0, found.confidence(v, u) > 0);
      ASSERT_LE(found.confidence(v, u), 1.0F);
      if (disparity_px == 0.0F) continue;
      ASSERT_GE(disparity_px, search.min_disparity_px - 1);
      ASSERT_LE(disparity_px, search.max_disparity_px() + 1);
      ASSERT_LE(disparity_px, u + 0.5F);
    }
}

template <class Params>
void expect_contract_on_any_number_of_threads(const RectifiedPair& pair, const Params& params) {
  const DisparityImage found = match(pair, params, 1);
  expect_contract(found, params.search);
  for (const int threads : {2, 3, 8}) {
    const DisparityImage again = match(pair, params, threads);
    EXPECT_EQ(cv::countNonZero(found.disparity_px != again.disparity_px), 0) << threads;
    EXPECT_EQ(cv::countNonZero(found.confidence != again.confidence), 0) << threads;
  }
}

class RandomInput : public testing::TestWithParam<unsigned> {};

INSTANTIATE_TEST_SUITE_P(Seeds, RandomInput, testing::Range(1U, 41U));

TEST_P(RandomInput, CensusSgmKeepsItsContractOnAnyNumberOfThreads) {
  Dice dice(GetParam());
  const RectifiedPair pair = random_pair(dice);
  expect_contract_on_any_number_of_threads(pair, random_sgm(dice));
}

TEST_P(RandomInput, AdaptiveWindowKeepsItsContractOnAnyNumberOfThreads) {
  Dice dice(GetParam());
  const RectifiedPair pair = random_pair(dice);
  expect_contract_on_any_number_of_threads(pair, random_windows(dice));
}

}  // namespace
}  // namespace stereovox
