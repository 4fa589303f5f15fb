#include "stereovox/stereo/winner_row.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

static_assert(kLocalWidth_px * kMaxMatchingCost < kNoLocalCost, "local sums must fit a byte");

// Eight candidates side by side, a byte each, the first one lowest.
using Bytes = std::uint64_t;
constexpr int kByte = 8;

Bytes load(const std::uint8_t* p) {
  Bytes bytes = 0;
  std::memcpy(&bytes, p, sizeof(bytes));
  return std::endian::native == std::endian::little ? bytes : __builtin_bswap64(bytes);
}

// Of the candidates of a row's pixels; see choose_locally.
class LocalCosts {
 public:
  LocalCosts(const std::uint8_t* cost, int width_px, int candidates)
      : cost_(cost), width_px_(width_px), candidates_(candidates) {}

  // Of those from candidate - kChoiceReach on. The first 2 kChoiceReach + 1 count.
  Bytes about(int x, int candidate) const {
    const bool is_inside =
        keeps_off(x, kHalf, width_px_) && keeps_off(candidate, kChoiceReach, candidates_);
    return is_inside ? inside(x, candidate) : anywhere(x, candidate);
  }

 private:
  static constexpr int kHalf = kLocalWidth_px / 2;

  // Whether all places up to `reach` from this one are among the first `count`.
  static bool keeps_off(int place, int reach, int count) {
    return place >= reach && place + reach < count;
  }

  const std::uint8_t* cost_of(int x) const {
    return cost_ + static_cast<std::ptrdiff_t>(x) * candidates_;
  }

  Bytes inside(int x, int candidate) const {
    const std::uint8_t* cost = cost_of(x - kHalf) + candidate - kChoiceReach;
    Bytes sums = 0;
    for (int k = 0; k < kLocalWidth_px; ++k, cost += candidates_) sums += load(cost);
    return sums;
  }

  Bytes anywhere(int x, int candidate) const {
    Bytes sums = 0;
    for (int i = 0; i <= 2 * kChoiceReach; ++i)
      sums |= sum_at(x, candidate + i - kChoiceReach) << i * kByte;
    return sums;
  }

  Bytes sum_at(int x, int candidate) const {
    if (candidate < 0 || candidate >= candidates_) return kNoLocalCost;
    Bytes sum = 0;
    for (int column = x - kHalf; column <= x + kHalf; ++column)
      sum += cost_of(std::clamp(column, 0, width_px_ - 1))[candidate];
    return sum;
  }

  const std::uint8_t* const cost_;
  const int width_px_, candidates_;
};

}  // namespace

WinnerRow::WinnerRow(int width_px)
    : candidate(width_px),
      cost(width_px),
      second(width_px),
      local_before(width_px),
      local(width_px),
      local_after(width_px) {}

WinnerPointers WinnerRow::pointers() { return {candidate.data(), cost.data(), second.data()}; }

void choose_locally(const std::uint8_t* cost, int candidates, WinnerRow& row) {
  constexpr int kChunk = 64;
  const int width = static_cast<int>(row.candidate.size());
  const LocalCosts costs(cost, width, candidates);
  for (int begin = 0; begin < width; begin += kChunk) {
    const int count = std::min(kChunk, width - begin);
    std::array<std::uint32_t, kChunk> first_four;
    std::array<std::uint8_t, kChunk> fifth;
    for (int i = 0; i < count; ++i) {
      const Bytes five = costs.about(begin + i, row.candidate[begin + i]);
      first_four[i] = static_cast<std::uint32_t>(five);
      fifth[i] = static_cast<std::uint8_t>(five >> sizeof(std::uint32_t) * kByte);
    }
    fastest_row_kernels().choose({first_four.data(), fifth.data()}, count,
                                 {.candidate = row.candidate.data() + begin,
                                  .before = row.local_before.data() + begin,
                                  .here = row.local.data() + begin,
                                  .after = row.local_after.data() + begin});
  }
}

}  // namespace stereovox
