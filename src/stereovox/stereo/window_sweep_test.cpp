#include "stereovox/stereo/window_sweep.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

namespace stereovox {
namespace {

// Noise of few or many grey values, in which arms are long or short.
RectifiedPair noise(cv::Size size, unsigned seed, int levels, int step_gray) {
  std::mt19937 random(seed);
  RectifiedPair pair;
  for (GrayImage* image : {&pair.left, &pair.right}) {
    image->pixels.create(size);
    for (std::uint8_t& p : image->pixels)
      p = static_cast<std::uint8_t>(random() % static_cast<unsigned>(levels) * step_gray);
  }
  return pair;
}

bool same(const cv::Mat1b& a, const cv::Mat1b& b) { return cv::countNonZero(a != b) == 0; }

bool same(const Arms& a, const Arms& b) {
  return same(a.left, b.left) && same(a.right, b.right) && same(a.up, b.up) && same(a.down, b.down);
}

struct Case {
  cv::Size size;
  int min_disparity_px, candidates, first_row, max_arm_px;
};

std::vector<WinnerRow> swept(const RectifiedPair& pair, const Arms& arms, const Case& c,
                             const WindowKernels& kernels) {
  const CensusPair padded = pad_for_census(pair);
  WindowSweep sweep(padded, arms, c.min_disparity_px, c.candidates, c.first_row, kernels);
  std::vector<WinnerRow> rows;
  for (int y = c.first_row; y < padded.height_px; ++y) {
    rows.emplace_back(padded.width_px);
    sweep.next_row(rows.back());
  }
  return rows;
}

class WindowSweepAndReference : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Sizes, WindowSweepAndReference,
    testing::Values(Case{{1, 1}, 0, 32, 0, 17}, Case{{2, 9}, 0, 64, 0, 1},
                    Case{{33, 67}, -20, 32, 40, 17}, Case{{37, 61}, 5, 64, 0, 24},
                    Case{{40, 21}, -40, 96, 1, 17}, Case{{71, 19}, 0, 128, 4, 9},
                    Case{{64, 5}, 100, 160, 0, 17}, Case{{50, 6}, -400, 192, 0, 17},
                    Case{{20, 5}, 3, 224, 0, 24}, Case{{90, 6}, 0, 256, 0, 17}));

TEST_P(WindowSweepAndReference, FindTheSameArmsAndWinnersOnEveryMachine) {
  const Case& c = GetParam();
  const ArmParams params{.max_arm_px = c.max_arm_px, .contrast_gray = 10};
  for (const auto& [levels, step_gray] : {std::pair{2, 9}, {3, 5}, {40, 1}, {256, 1}}) {
    const RectifiedPair pair = noise(c.size, 3, levels, step_gray);
    const Arms arms = arms_reference(pair.left.pixels, params);
    const auto expected =
        windows_reference(pair, arms, c.min_disparity_px, c.candidates, c.first_row, c.size.height);
    for (const WindowKernels* kernels :
         {&portable_window_kernels(), avx2_window_kernels(), avx512_window_kernels()}) {
      if (kernels == nullptr) continue;  // not on this machine
      EXPECT_TRUE(same(arms_of(pair.left.pixels, params, *kernels, 2), arms)) << levels;
      EXPECT_TRUE(swept(pair, arms, c, *kernels) == expected) << levels;
    }
  }
}

TEST(WindowSweep, TheLargestSumsOfTheLargestWindowsFit) {
  const cv::Size size(60, 60);
  const Case c{size, 0, 32, 0, kMaxArm_px};
  RectifiedPair pair = noise(size, 1, 256, 1);
  const Arms arms =
      arms_of(cv::Mat1b(size, 100), {.max_arm_px = kMaxArm_px}, fastest_window_kernels(), 1);
  EXPECT_EQ(arms.left(30, 30), kMaxArm_px);
  EXPECT_TRUE(swept(pair, arms, c, fastest_window_kernels()) ==
              windows_reference(pair, arms, 0, 32, 0, size.height));
}

TEST(Arms, EndAtEdgesAndAtTheBorder) {
  cv::Mat1b image(40, 40, std::uint8_t{50});
  image.colRange(20, 40).setTo(80);
  const Arms arms =
      arms_of(image, {.max_arm_px = 17, .contrast_gray = 10}, fastest_window_kernels(), 1);
  EXPECT_EQ(arms.right(10, 15), 4);
  EXPECT_EQ(arms.right(10, 19), 1) << "an arm reaches at least one pixel";
  EXPECT_EQ(arms.left(10, 15), 15);
  EXPECT_EQ(arms.left(10, 19), 17);
  EXPECT_EQ(arms.right(10, 39), 0);
  EXPECT_EQ(arms.up(10, 15), 10);
  EXPECT_EQ(arms.down(10, 15), 17);
}

}  // namespace
}  // namespace stereovox
