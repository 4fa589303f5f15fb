#include "stereovox/stereo/winner_row.h"

#include <gtest/gtest.h>

#include <random>

#include "stereovox/stereo/census_sweep.h"

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

}  // namespace
}  // namespace stereovox
