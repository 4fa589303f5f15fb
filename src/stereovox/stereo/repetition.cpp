#include "stereovox/stereo/repetition.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

constexpr int kMostSamples = RepetitionBand::kBlockWidth_px * RepetitionBand::kBlockHeight_px;
static_assert(kMostSamples * kMaxMatchingCost < 1 << 16, "sums must fit 16 bits");

// A surface nearer to the one found is the same one, seen less sharply.
constexpr int kNearestShift = 3;
// Of how much better the one found is than the average of all candidates.
constexpr double kAsGood = 0.8;
// By so much it must be better, or there is nothing to compare with.
constexpr double kLeastDepth = 1.0;

}  // namespace

RepetitionBand::RepetitionBand(int width_px, int candidates)
    : width_px_(width_px),
      candidates_(candidates),
      blocks_((width_px + kBlockWidth_px - 1) / kBlockWidth_px,
              Block{.cost = std::vector<std::uint16_t>(2 * candidates),
                    .winners = std::vector<int>(candidates)}) {}

void RepetitionBand::add_row(const std::uint8_t* cost, const std::uint8_t* winner) {
  for (int begin = 0; Block & block : blocks_) {
    const int width = std::min(kBlockWidth_px, width_px_ - begin);
    fastest_row_kernels().along_surface(cost + static_cast<std::ptrdiff_t>(begin) * candidates_,
                                        candidates_, winner + begin, width, kColumnStep_px,
                                        block.cost.data());
    for (int x = 0; x < width; x += kColumnStep_px) ++block.winners[winner[begin + x]];
    block.samples += (width + kColumnStep_px - 1) / kColumnStep_px;
    begin += width;
  }
}

std::vector<PixelSpan> RepetitionBand::take_repeating() {
  std::vector<PixelSpan> found;
  for (int begin = 0; Block & block : blocks_) {
    const int end = std::min(begin + kBlockWidth_px, width_px_);
    if (repeats(block)) found.push_back({begin, end});
    begin = end;
    block.samples = 0;
    std::ranges::fill(block.cost, std::uint16_t{0});
    std::ranges::fill(block.winners, 0);
  }
  return found;
}

bool RepetitionBand::repeats(const Block& block) const {
  const double samples = block.samples;
  const double average =
      std::accumulate(block.cost.begin(), block.cost.end(), 0) / (samples * candidates_);
  const double depth = average - block.cost[candidates_] / samples;
  if (!(depth >= kLeastDepth)) return false;
  const double limit = average - kAsGood * depth;
  const auto is_as_good = [&](int shift, int count) {
    return 2 * count >= block.samples && block.cost[candidates_ + shift] < limit * count;
  };
  // Pixels whose candidate moved by so much exists, in either direction.
  int up = block.samples, down = block.samples;
  for (int shift = 1; shift < candidates_; ++shift) {
    up -= block.winners[candidates_ - shift];
    down -= block.winners[shift - 1];
    if (shift >= kNearestShift && (is_as_good(shift, up) || is_as_good(-shift, down))) return true;
  }
  return false;
}

}  // namespace stereovox
