#include "stereovox/stereo/multiple_windows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "stereovox/stereo/synthetic_pair_for_test.h"

namespace stereovox {
namespace {

RectifiedPair noise(cv::Size size, unsigned seed, unsigned levels) {
  std::mt19937 random(seed);
  RectifiedPair pair;
  for (GrayImage* image : {&pair.left, &pair.right}) {
    image->pixels.create(size);
    for (std::uint8_t& p : image->pixels) p = static_cast<std::uint8_t>(random() % levels);
  }
  return pair;
}

struct Case {
  cv::Size size;
  int min_disparity_px, candidates, first_row, half_px;
};

std::vector<WinnerRow> swept(const RectifiedPair& pair, const MultipleWindows& windows,
                             const Case& c, const WindowKernels& kernels) {
  const CensusPair padded = pad_for_census(pair);
  MultipleWindowSweep sweep(padded, windows, c.min_disparity_px, c.candidates, c.first_row,
                            kernels);
  std::vector<WinnerRow> rows;
  for (int y = c.first_row; y < padded.height_px; ++y) {
    rows.emplace_back(padded.width_px);
    sweep.next_row(rows.back());
  }
  return rows;
}

constexpr std::array kNeighbourhoodsOfTests = {NeighbourWindows::none, NeighbourWindows::four,
                                               NeighbourWindows::eight};

class MultipleWindowsAndReference : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Sizes, MultipleWindowsAndReference,
    testing::Values(Case{{1, 1}, 0, 32, 0, 4}, Case{{2, 9}, 0, 64, 0, 1},
                    Case{{33, 67}, -20, 32, 40, 4}, Case{{37, 41}, 5, 64, 0, 6},
                    Case{{40, 21}, -40, 96, 1, 3}, Case{{51, 19}, 0, 128, 4, 2},
                    Case{{44, 5}, 100, 160, 0, 4}, Case{{30, 6}, -400, 192, 0, 3},
                    Case{{20, 5}, 3, 224, 0, 10}, Case{{30, 6}, 0, 256, 0, 1}));

TEST_P(MultipleWindowsAndReference, FindTheSameWinnersOnEveryMachine) {
  const Case& c = GetParam();
  const RectifiedPair pair = noise(c.size, 3, 256);
  for (const NeighbourWindows neighbours : kNeighbourhoodsOfTests) {
    const MultipleWindows windows{.half_px = c.half_px, .neighbours = neighbours};
    const auto expected = multiple_windows_reference(pair, windows, c.min_disparity_px,
                                                     c.candidates, c.first_row, c.size.height);
    for (const WindowKernels* kernels :
         {&portable_window_kernels(), avx2_window_kernels(), avx512_window_kernels()}) {
      if (kernels == nullptr) continue;  // not on this machine
      EXPECT_TRUE(swept(pair, windows, c, *kernels) == expected) << number_of(neighbours);
    }
  }
}

// Brightness falls in one image and rises in the other, down and to the right: all bits of the
// census and the slopes differ.
TEST(MultipleWindows, TheLargestSumsOfTheLargestWindowsFit) {
  const cv::Size size(16, 20);
  RectifiedPair pair;
  pair.left.pixels.create(size);
  pair.right.pixels.create(size);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      pair.right.pixels(v, u) = static_cast<std::uint8_t>(8 * v + 3 * u);
      pair.left.pixels(v, u) = static_cast<std::uint8_t>(255 - pair.right.pixels(v, u));
    }
  const MultipleWindows windows{.half_px = kMaxWindowHalf_px};
  EXPECT_EQ(matching_cost_reference(pair, 8, 10, 0), kMaxMatchingCost);
  EXPECT_TRUE(swept(pair, windows, {size, 0, 32, 0, 0}, fastest_window_kernels()) ==
              multiple_windows_reference(pair, windows, 0, 32, 0, size.height));
}

// A post before a wall, with the noise of two cameras.
constexpr int kPost_px = 22, kWall_px = 6, kFirstOfPost = 70, kEndOfPost = 110;

RectifiedPair noisy_post(double noise_gray) {
  RectifiedPair pair = synthetic_pair({160, 240}, [](int u, int) {
    return u >= kFirstOfPost && u < kEndOfPost ? kPost_px : kWall_px;
  });
  cv::RNG random(5);
  for (GrayImage* const image : {&pair.left, &pair.right}) {
    cv::Mat1f noise(image->pixels.size());
    random.fill(noise, cv::RNG::NORMAL, 0, noise_gray);
    cv::add(image->pixels, noise, image->pixels, cv::noArray(), CV_8U);
  }
  return pair;
}

// Of the pixels near the right edge of the post, where nothing is hidden, those that are found
// within a pixel.
double share_right_at_border(const MultipleWindows& windows) {
  constexpr int kNear_px = 5;
  constexpr double kNoise_gray = 30;
  const RectifiedPair pair = noisy_post(kNoise_gray);
  const Case c{pair.left.pixels.size(), 0, 32, 0, windows.half_px};
  const auto rows = swept(pair, windows, c, fastest_window_kernels());
  int right = 0, count = 0;
  for (int v = 0; v < c.size.height; ++v)
    for (int u = kEndOfPost - kNear_px; u < kEndOfPost + kNear_px; ++u, ++count) {
      const int found_px = c.candidates - 1 - rows[v].candidate[u];
      right += std::abs(found_px - (u < kEndOfPost ? kPost_px : kWall_px)) <= 1 ? 1 : 0;
    }
  return static_cast<double>(right) / count;
}

TEST(MultipleWindows, SeeTheBorderOfAThingBetterThanOneOfThemAlone) {
  for (const int half_px : {3, 4, 5}) {
    const double alone = share_right_at_border({half_px, NeighbourWindows::none});
    for (const NeighbourWindows neighbours : {NeighbourWindows::four, NeighbourWindows::eight})
      EXPECT_GT(share_right_at_border({half_px, neighbours}), alone + 0.04)
          << half_px << " px, " << number_of(neighbours) << " neighbours";
  }
}

}  // namespace
}  // namespace stereovox
