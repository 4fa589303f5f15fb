#include "stereovox/stereo/winner_row.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace stereovox {
namespace {

constexpr int kHalf = kLocalWidth_px / 2;
static_assert(kLocalWidth_px * kMaxMatchingCost < kNoLocalCost, "local sums must fit a byte");

// Where the costs of the pixels about one begin, seen from where its own do.
using Offsets = std::array<std::ptrdiff_t, kLocalWidth_px>;

// Eight candidates side by side, a byte each, the first one lowest. Five of the sums matter.
using Bytes = std::uint64_t;
constexpr int kByte = 8, kReach = 2;  // candidates on either side of the winner

Bytes load(const std::uint8_t* p) {
  Bytes bytes = 0;
  std::memcpy(&bytes, p, sizeof(bytes));
  return std::endian::native == std::endian::little ? bytes : __builtin_bswap64(bytes);
}

// The local costs of the candidates from `candidate` - kReach on, all of which exist.
Bytes inner_costs(const std::uint8_t* cost, const Offsets& offsets, int candidate) {
  Bytes sums = 0;
  for (const std::ptrdiff_t offset : offsets) sums += load(cost + offset + candidate - kReach);
  return sums;
}

// The same where some lie before the first candidate or behind the last: they get kNoLocalCost.
Bytes outer_costs(const std::uint8_t* cost, const Offsets& offsets, int candidate, int candidates) {
  constexpr Bytes kWall = kNoLocalCost;
  Bytes sums = 0;
  for (int i = 0; i <= 2 * kReach; ++i) {
    const int c = candidate + i - kReach;
    Bytes sum = c < 0 || c >= candidates ? kWall : 0;
    for (const std::ptrdiff_t offset : offsets) sum += sum != kWall ? cost[offset + c] : 0;
    sums |= sum << i * kByte;
  }
  return sums;
}

std::uint8_t byte_at(Bytes bytes, int i) { return static_cast<std::uint8_t>(bytes >> i * kByte); }

// How far the best of the winner and its neighbours is from it. Without branches, which nobody
// could predict.
int step_to_best(Bytes costs) {
  const int before = byte_at(costs, kReach - 1), here = byte_at(costs, kReach);
  const int is_before = before < here;
  const int is_after = byte_at(costs, kReach + 1) < (is_before != 0 ? before : here);
  return is_after - (is_before & ~is_after);
}

// The row as plain pointers, so that nothing written can move it.
struct LocalPointers {
  std::uint8_t *candidate, *before, *here, *after;

  void choose(int x, Bytes costs) const {
    const int step = step_to_best(costs);
    const auto three = static_cast<std::uint32_t>(costs >> (kReach - 1 + step) * kByte);
    candidate[x] = static_cast<std::uint8_t>(candidate[x] + step);
    before[x] = byte_at(three, 0);
    here[x] = byte_at(three, 1);
    after[x] = byte_at(three, 2);
  }
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
  const int width = static_cast<int>(row.candidate.size());
  const LocalPointers out = {row.candidate.data(), row.local_before.data(), row.local.data(),
                             row.local_after.data()};
  const auto choose_at = [&, out, cost](int x, const Offsets& offsets) {
    const std::uint8_t* const own = cost + static_cast<std::ptrdiff_t>(x) * candidates;
    const int winner = out.candidate[x];
    const bool is_inner = winner >= kReach && winner + kReach < candidates;
    out.choose(x, is_inner ? inner_costs(own, offsets, winner)
                           : outer_costs(own, offsets, winner, candidates));
  };
  const auto offsets_at = [&](int x) {
    Offsets offsets;
    for (int k = 0; k < kLocalWidth_px; ++k)
      offsets[k] = (std::clamp(x + k - kHalf, 0, width - 1) - x) * std::ptrdiff_t{candidates};
    return offsets;
  };
  const int begin = std::min(kHalf, width), end = std::max(begin, width - kHalf);
  for (int x = 0; x < begin; ++x) choose_at(x, offsets_at(x));
  for (int x = end; x < width; ++x) choose_at(x, offsets_at(x));
  const Offsets inside = offsets_at(kHalf);
  for (int x = begin; x < end; ++x) choose_at(x, inside);
}

}  // namespace stereovox
