// The loops of window_kernels.h for one kind of vector of bytes; included by one file for each
// kind. Sums of 16 bits are plain loops over a constant count, which the compiler makes vectors of.
#pragma once

#include "stereovox/stereo/census_kernels_impl.h"
#include "stereovox/stereo/window_kernels.h"

namespace stereovox {
namespace {

using Sum = std::uint16_t;

template <class S>
void grow_arms(const ArmRow& row, std::uint8_t* out) {
  using V = typename S::V;
  const V limit = S::spread(row.contrast_gray), one = S::spread(1);
  for (int x = 0; x < row.width_px; x += S::kSize) {
    const std::uint8_t* const from = row.from + x;
    const V here = S::load(from);
    V grows = one, arm = S::spread(0);
    for (int k = 1; k <= row.max_arm_px; ++k) {
      const V there = S::load(from + k * row.step);
      const V difference =
          S::either(S::subtract_saturated(here, there), S::subtract_saturated(there, here));
      grows = S::both(grows, S::is_at_least(limit, difference));
      arm = S::add(arm, grows);
    }
    S::store(out + x, arm);
  }
}

// The costs of the candidates of pixel x, added to the sums of the pixels before it in the row.
template <class S, int kCandidates>
[[gnu::always_inline]] inline void add_costs(const GatherRow& row, int x) {
  typename S::V words[kPlanes];
  std::uint8_t* const cost = row.cost + x * kCandidates;
  for (int p = 0; p < kPlanes; ++p) words[p] = S::spread(row.left.planes[p][x]);
  for (int i = 0; i < kCandidates; i += S::kSize)
    S::store(cost + i, matching_cost<S>(words, row.right, x + i));
  const Sum* const before = row.along + x * kCandidates;
  Sum* __restrict const after = row.along + (x + 1) * kCandidates;
  for (int i = 0; i < kCandidates; ++i) after[i] = static_cast<Sum>(before[i] + cost[i]);
}

template <class S, int kCandidates>
void gather_row(const GatherRow& row) {
  for (int i = 0; i < kCandidates; ++i) row.along[i] = 0;
  for (int x = 0; x < row.width_px; ++x) add_costs<S, kCandidates>(row, x);
  for (int x = 0; x < row.width_px; ++x) {
    const Sum* const begin = row.along + (x - row.arm_left[x]) * kCandidates;
    const Sum* const end = row.along + (x + row.arm_right[x] + 1) * kCandidates;
    const Sum* const above = row.above + x * kCandidates;
    Sum* __restrict const below = row.below + x * kCandidates;
    for (int i = 0; i < kCandidates; ++i) below[i] = static_cast<Sum>(above[i] + end[i] - begin[i]);
  }
}

constexpr Sum kNoSum = 0xffff;
// Or'ed with the sums of all candidates, from here on at candidate 0, this takes three neighbours
// out of the race.
struct ThreeSumsOut {
  Sum sums[2 * kMaxCandidates] = {};
  constexpr ThreeSumsOut() {
    for (int i = -1; i <= 1; ++i) sums[kMaxCandidates + i] = kNoSum;
  }
};
constexpr ThreeSumsOut kThreeSumsOut;

struct BestSum {
  int candidate;
  Sum sum, second;  // second: of those that are not its neighbours
};

constexpr Sum smaller(Sum a, Sum b) { return a < b ? a : b; }

template <int kCandidates>
[[gnu::always_inline]] inline BestSum best_of(const Sum* sums) {
  Sum smallest = kNoSum, first = kNoSum, second = kNoSum;
  for (int i = 0; i < kCandidates; ++i) smallest = smaller(smallest, sums[i]);
  for (int i = 0; i < kCandidates; ++i)
    first = smaller(first, sums[i] == smallest ? static_cast<Sum>(i) : kNoSum);
  const Sum* const out = kThreeSumsOut.sums + kMaxCandidates - first;
  for (int i = 0; i < kCandidates; ++i)
    second = smaller(second, static_cast<Sum>(sums[i] | out[i]));
  return {first, smallest, second};
}

// The mean over a window of `area` pixels, rounded.
constexpr std::uint8_t mean_cost(Sum sum, int area) {
  return static_cast<std::uint8_t>((sum * kMeanCostSteps + area / 2) / area);
}

template <class S, int kCandidates>
void choose_row(const ChoiceRow& row, const WinnerPointers& out) {
  SweepRow costs;
  costs.width_px = row.width_px;
  costs.cost = row.cost;
  WalledCosts<kCandidates> walled;
  LocalSums<S, kCandidates> local(costs, 0);
  for (int x = 0; x < row.width_px; ++x) {
    const Sum* const before = row.before[row.arm_up[x]] + x * kCandidates;
    const Sum* const after = row.after[row.arm_down[x]] + x * kCandidates;
    Sum sums[kCandidates];
    for (int i = 0; i < kCandidates; ++i) sums[i] = static_cast<Sum>(after[i] - before[i]);
    const BestSum best = best_of<kCandidates>(sums);
    out.candidate[x] = static_cast<std::uint8_t>(best.candidate);
    out.cost[x] = mean_cost(best.sum, row.area[x]);
    out.second[x] = mean_cost(best.second, row.area[x]);
    if (x > 0) local.move_to(x, 1);
    local.choose(x, walled, out);
  }
}

template <class S>
constexpr WindowKernels make_window_kernels() {
  return {
      .census = census_row<S>,
      .arms = grow_arms<S>,
      .gather = {gather_row<S, 32>, gather_row<S, 64>, gather_row<S, 96>, gather_row<S, 128>,
                 gather_row<S, 160>, gather_row<S, 192>, gather_row<S, 224>, gather_row<S, 256>},
      .choose = {choose_row<S, 32>, choose_row<S, 64>, choose_row<S, 96>, choose_row<S, 128>,
                 choose_row<S, 160>, choose_row<S, 192>, choose_row<S, 224>, choose_row<S, 256>}};
}

}  // namespace
}  // namespace stereovox
