#include "stereovox/stereo/winner_row.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

// Winners anywhere, the ends of the candidates among them, and costs with many equals.
WinnerRow random_winners(int width_px, int candidates, std::mt19937& random) {
  WinnerRow row(width_px);
  for (std::uint8_t& c : row.candidate) {
    const auto place = static_cast<int>(random() % 6);
    const auto anywhere = static_cast<int>(random() % static_cast<unsigned>(candidates));
    c = static_cast<std::uint8_t>(place < 2 ? place
                                            : (place < 4 ? candidates - place + 1 : anywhere));
  }
  return row;
}

TEST(WinnerRow, ChoosesAsThePlainVersionDoes) {
  std::mt19937 random(5);
  for (const int candidates : {32, 64, 256})
    for (const int width : {1, 2, 3, 4, 5, 6, 40}) {
      std::vector<std::uint8_t> cost(width * candidates + kRowSlack, 255);
      for (int i = 0; i < width * candidates; ++i)
        cost[i] = static_cast<std::uint8_t>(random() % (width % 2 == 0 ? 2 : kMaxMatchingCost + 1));
      WinnerRow row = random_winners(width, candidates, random);
      WinnerRow plain = row;
      choose_locally(cost.data(), candidates, row);
      choose_locally_reference([&](int x, int c) { return cost[x * candidates + c]; }, candidates,
                               plain);
      EXPECT_EQ(row, plain) << width << " x " << candidates;
    }
}

TEST(WinnerRow, DoubtsAsThePlainVersionDoes) {
  std::mt19937 random(6);
  for (const int candidates : {32, 64, 256})
    for (const int width : {1, 2, 3, 4, 5, 6, 40}) {
      std::vector<std::uint8_t> cost(width * candidates + kRowSlack, 255);
      for (int i = 0; i < width * candidates; ++i)
        cost[i] =
            static_cast<std::uint8_t>(random() % 8 == 0 ? 1 + random() % kMaxMatchingCost : 0);
      WinnerRow row = random_winners(width, candidates, random);
      std::ranges::fill(row.second, std::uint8_t{9});
      choose_locally(cost.data(), candidates, row);
      WinnerRow plain = row;
      doubt_repetitions(cost.data(), candidates, row);
      doubt_repetitions_reference([&](int x, int c) { return cost[x * candidates + c]; },
                                  candidates, plain);
      EXPECT_EQ(row, plain) << width << " x " << candidates;
    }
}

TEST(WinnerRow, DoubtsWhatCostsNothingElsewhereButNotBesideTheWinner) {
  constexpr int kWidth_px = 9, kCandidates = 32, kWinner = 10;
  const auto second_without_cost_at = [](int candidate) {
    std::vector<std::uint8_t> cost(kWidth_px * kCandidates + kRowSlack, 3);
    for (int x = 0; x < kWidth_px; ++x)
      cost[x * kCandidates + kWinner] = cost[x * kCandidates + candidate] = 0;
    WinnerRow row(kWidth_px);
    std::ranges::fill(row.candidate, std::uint8_t{kWinner});
    std::ranges::fill(row.second, std::uint8_t{9});
    doubt_repetitions(cost.data(), kCandidates, row);
    return row.second[4];
  };
  EXPECT_EQ(second_without_cost_at(kWinner), 9);
  EXPECT_EQ(second_without_cost_at(kWinner + kChoiceReach), 9);
  EXPECT_EQ(second_without_cost_at(kWinner + kChoiceReach + 1), 0);
  EXPECT_EQ(second_without_cost_at(0), 0);
}

}  // namespace
}  // namespace stereovox
