#include "stereovox/stereo/winner_row.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdlib>
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

  // For each pixel from first_x to end_x those of its candidates from candidate[x] - kChoiceReach
  // on. The first 2 kChoiceReach + 1 count.
  void fill(const std::uint8_t* candidate, int first_x, int end_x, Bytes* out) const {
    const int first_inside = std::clamp(kHalf, first_x, end_x);
    const int end_inside = std::clamp(width_px_ - kHalf, first_inside, end_x);
    for (int x = first_x; x < first_inside; ++x) *out++ = anywhere(x, candidate[x]);
    const std::uint8_t* cost = cost_of(std::max(first_inside - kHalf, 0));
    for (int x = first_inside; x < end_inside; ++x, cost += candidates_)
      *out++ = has_neighbours(candidate[x]) ? inside(cost + candidate[x] - kChoiceReach)
                                            : anywhere(x, candidate[x]);
    for (int x = end_inside; x < end_x; ++x) *out++ = anywhere(x, candidate[x]);
  }

 private:
  static constexpr int kHalf = kLocalWidth_px / 2;

  bool has_neighbours(int candidate) const {
    return candidate >= kChoiceReach && candidate + kChoiceReach < candidates_;
  }

  const std::uint8_t* cost_of(int x) const { return cost_ + x * candidates_; }

  // `cost` is that of the first candidate and pixel which count.
  Bytes inside(const std::uint8_t* cost) const {
    Bytes sums = 0;
    for (int k = 0; k < kLocalWidth_px; ++k) sums += load(cost + k * candidates_);
    return sums;
  }

  // Needed seldom, so that the loop above keeps its registers.
  [[gnu::noinline]] Bytes anywhere(int x, int candidate) const {
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
  const int width_px_;
  const std::ptrdiff_t candidates_;
};

// Whether a candidate farther than kChoiceReach from the winner has no local cost at all.
bool costs_nothing_elsewhere(const std::array<const std::uint8_t*, kLocalWidth_px>& columns,
                             int candidates, int winner) {
  constexpr Bytes kSevenBits = 0x7F7F7F7F7F7F7F7FULL, kHighBit = ~kSevenBits;
  static_assert(kMaxMatchingCost < 1 << (kByte - 2), "bytes must not carry over");
  for (int first = 0; first < candidates; first += kByte) {
    Bytes any = 0;
    for (const std::uint8_t* const column : columns) any |= load(column + first);
    for (Bytes none = ~(any + kSevenBits) & kHighBit; none != 0; none &= none - 1)
      if (std::abs(first + std::countr_zero(none) / kByte - winner) > kChoiceReach) return true;
  }
  return false;
}

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
    std::array<Bytes, kChunk> five;
    std::array<std::uint32_t, kChunk> first_four;
    std::array<std::uint8_t, kChunk> fifth;
    costs.fill(row.candidate.data(), begin, begin + count, five.data());
    for (int i = 0; i < count; ++i) {
      first_four[i] = static_cast<std::uint32_t>(five[i]);
      fifth[i] = static_cast<std::uint8_t>(five[i] >> sizeof(std::uint32_t) * kByte);
    }
    fastest_row_kernels().choose({first_four.data(), fifth.data()}, count,
                                 {.candidate = row.candidate.data() + begin,
                                  .before = row.local_before.data() + begin,
                                  .here = row.local.data() + begin,
                                  .after = row.local_after.data() + begin});
  }
}

void doubt_repetitions(const std::uint8_t* cost, int candidates, WinnerRow& row) {
  const int width = static_cast<int>(row.candidate.size());
  const auto next_without_cost = [&](int x) {  // std::find, but by vectors
    const void* const found = std::memchr(row.local.data() + x, 0, width - x);
    return found == nullptr
               ? width
               : static_cast<int>(static_cast<const std::uint8_t*>(found) - row.local.data());
  };
  for (int x = next_without_cost(0); x < width; x = next_without_cost(x + 1)) {
    std::array<const std::uint8_t*, kLocalWidth_px> columns;
    for (int k = 0; k < kLocalWidth_px; ++k)
      columns[k] = cost + std::clamp(x + k - kLocalWidth_px / 2, 0, width - 1) * candidates;
    if (costs_nothing_elsewhere(columns, candidates, row.candidate[x])) row.second[x] = row.cost[x];
  }
}

}  // namespace stereovox
