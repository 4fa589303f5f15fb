#include "stereovox/stereo/repetition.h"

#include <gtest/gtest.h>

#include <random>

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {
namespace {

constexpr int kBandCandidates = 64, kBandWinner = 20;

// Costs that are low at the winner, and in some columns at others, a period apart.
struct BandRow {
  std::vector<std::uint8_t> cost, winner;

  BandRow(int width_px, PixelSpan repeating, int period, unsigned seed)
      : cost(width_px * kBandCandidates), winner(width_px, kBandWinner) {
    std::mt19937 random(seed);
    for (int x = 0; x < width_px; ++x)
      for (int c = 0; c < kBandCandidates; ++c) {
        const bool repeats = repeating.begin <= x && x < repeating.end;
        const bool is_low = c == kBandWinner || (repeats && (c - kBandWinner) % period == 0);
        cost[x * kBandCandidates + c] = static_cast<std::uint8_t>((is_low ? 3 : 12) + random() % 4);
      }
  }
};

std::vector<PixelSpan> repeating_of(int width_px, PixelSpan repeating, int period) {
  RepetitionBand band(width_px, kBandCandidates);
  for (unsigned v = 0; v < 16; ++v) {
    const BandRow row(width_px, repeating, period, v);
    band.add_row(row.cost.data(), row.winner.data());
  }
  return band.take_repeating();
}

TEST(RepetitionBand, FindsTheBlocksThatRepeat) {
  EXPECT_EQ(repeating_of(200, {64, 128}, 16), (std::vector<PixelSpan>{{64, 128}}));
  EXPECT_EQ(repeating_of(200, {0, 200}, 9),
            (std::vector<PixelSpan>{{0, 64}, {64, 128}, {128, 192}, {192, 200}}));
  EXPECT_TRUE(repeating_of(200, {0, 0}, 16).empty());
}

TEST(RepetitionBand, NeighboursOfTheWinnerAreNoRepetition) {
  EXPECT_TRUE(repeating_of(64, {0, 64}, 100).empty());
  RepetitionBand band(64, kBandCandidates);
  std::vector<std::uint8_t> cost(64 * kBandCandidates, 12), winner(64, kBandWinner);
  for (int x = 0; x < 64; ++x)
    for (int c = kBandWinner - 2; c <= kBandWinner + 2; ++c) cost[x * kBandCandidates + c] = 3;
  for (int v = 0; v < 16; ++v) band.add_row(cost.data(), winner.data());
  EXPECT_TRUE(band.take_repeating().empty());
}

TEST(RepetitionBand, WhereNothingIsToBeSeenNothingRepeats) {
  RepetitionBand band(64, kBandCandidates);
  const std::vector<std::uint8_t> cost(64 * kBandCandidates, 5), winner(64, kBandWinner);
  for (int v = 0; v < 16; ++v) band.add_row(cost.data(), winner.data());
  EXPECT_TRUE(band.take_repeating().empty());
}

TEST(RepetitionBand, BeginsAnew) {
  RepetitionBand band(64, kBandCandidates);
  const BandRow repeating(64, {0, 64}, 16, 1), plain(64, {0, 0}, 16, 2);
  band.add_row(repeating.cost.data(), repeating.winner.data());
  EXPECT_EQ(band.take_repeating().size(), 1U);
  band.add_row(plain.cost.data(), plain.winner.data());
  EXPECT_TRUE(band.take_repeating().empty());
}

// Surfaces of any shape: only the distance from the winner counts.
TEST(RepetitionBand, FollowsTheSurface) {
  RepetitionBand band(64, kBandCandidates);
  std::vector<std::uint8_t> cost(64 * kBandCandidates, 12), winner(64);
  for (int x = 0; x < 64; ++x) {
    winner[x] = static_cast<std::uint8_t>(10 + x / 4);
    cost[x * kBandCandidates + winner[x]] = cost[x * kBandCandidates + winner[x] + 11] = 3;
  }
  for (int v = 0; v < 16; ++v) band.add_row(cost.data(), winner.data());
  EXPECT_EQ(band.take_repeating().size(), 1U);
}

}  // namespace
}  // namespace stereovox
