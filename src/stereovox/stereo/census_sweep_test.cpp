#include "stereovox/stereo/census_sweep.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

namespace stereovox {
namespace {

RectifiedPair noise(cv::Size size, unsigned seed, int levels) {
  std::mt19937 random(seed);
  RectifiedPair pair;
  for (GrayImage* image : {&pair.left, &pair.right}) {
    image->pixels.create(size);
    for (std::uint8_t& p : image->pixels)
      p = static_cast<std::uint8_t>(random() % static_cast<unsigned>(levels) * (255 / levels));
  }
  return pair;
}

SweepParams params_with(int min_disparity_px, int candidates) {
  SweepParams params{.min_disparity_px = min_disparity_px,
                     .candidates = candidates,
                     .small_penalty = 7,
                     .nearer_penalty = 4,
                     .large_penalty = {}};
  for (int step = 0; step < kPenaltySteps; ++step)
    params.large_penalty[step] = static_cast<std::uint8_t>(8 + 6000 / (step + 30));
  return params;
}

struct Case {
  cv::Size size;
  int min_disparity_px, candidates, first_row;
};

std::vector<WinnerRow> swept(const RectifiedPair& pair, const SweepParams& params, int first_row,
                             const CensusKernels& kernels) {
  const CensusPair padded = pad_for_census(pair);
  CensusSweep sweep(padded, params, first_row, kernels);
  std::vector<WinnerRow> rows;
  for (int y = first_row; y < padded.height_px; y += 2) {
    std::array<WinnerRow, 2> found = {WinnerRow(padded.width_px), WinnerRow(padded.width_px)};
    sweep.next_rows(found);
    rows.insert(rows.end(), found.begin(), found.begin() + std::min(2, padded.height_px - y));
  }
  return rows;
}

class CensusSweepAndReference : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Sizes, CensusSweepAndReference,
                         testing::Values(Case{{1, 1}, 0, 32, 0}, Case{{2, 9}, 0, 64, 0},
                                         Case{{33, 7}, -20, 32, 2}, Case{{37, 21}, 5, 64, 0},
                                         Case{{40, 11}, -40, 96, 1}, Case{{71, 9}, 0, 128, 4},
                                         Case{{64, 5}, 100, 160, 0}, Case{{50, 6}, -400, 192, 0},
                                         Case{{20, 5}, 3, 224, 0}, Case{{90, 6}, 0, 256, 0}));

TEST_P(CensusSweepAndReference, FindTheSameWinnersOnEveryMachine) {
  const auto& [size, min_disparity_px, candidates, first_row] = GetParam();
  const SweepParams params = params_with(min_disparity_px, candidates);
  for (const int levels : {2, 5, 255}) {
    const RectifiedPair pair = noise(size, 3, levels);
    const auto expected = sweep_reference(pair, params, first_row, size.height);
    for (const CensusKernels* kernels :
         {&portable_census_kernels(), avx2_census_kernels(), avx512_census_kernels()}) {
      if (kernels == nullptr) continue;  // not on this machine
      EXPECT_EQ(swept(pair, params, first_row, *kernels), expected) << levels;
    }
  }
}

TEST(CensusSweep, RowsThatAreSkippedStillGuideThePaths) {
  const RectifiedPair pair = noise({45, 12}, 5, 255);
  const SweepParams params = params_with(0, 32);
  const CensusPair padded = pad_for_census(pair);
  CensusSweep sweep(padded, params, 0, fastest_census_kernels());
  for (int y = 0; y < 11; ++y) sweep.skip_row();
  std::array<WinnerRow, 2> last = {WinnerRow(45), WinnerRow(45)};
  sweep.next_rows(last);
  EXPECT_EQ(last[0], sweep_reference(pair, params, 0, 12).back());
  EXPECT_NE(last[0], sweep_reference(pair, params, 11, 12).back());
}

}  // namespace
}  // namespace stereovox
