// The loops of window_kernels.h for one kind of vector of bytes; included by one file for each
// kind. Sums of 16 bits are plain loops over a constant count, which the compiler makes vectors of.
#pragma once

#include "stereovox/stereo/census_kernels_impl.h"
#include "stereovox/stereo/window_kernels.h"

// Each including file is to have its own: NOLINTBEGIN(misc-definitions-in-headers)
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
  std::uint8_t* const cost = row.cost + x * kCandidates;
  compare<S, kCandidates>(row.left, row.right, x, cost);
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

struct Places {
  Sum at[kMaxCandidates] = {};
  constexpr Places() {
    for (int i = 0; i < kMaxCandidates; ++i) at[i] = static_cast<Sum>(i);
  }
};
constexpr Places kPlaces;

struct BestSum {
  int candidate;
  Sum sum, second;  // second: of those that are not its neighbours
};

constexpr Sum smaller(Sum a, Sum b) { return a < b ? a : b; }

template <int kCandidates>
[[gnu::always_inline]] inline BestSum best_of(const Sum* sums) {
  Sum smallest = kNoSum, first = kNoSum, second = kNoSum;
  for (int i = 0; i < kCandidates; ++i) smallest = smaller(smallest, sums[i]);
  // Without a comparison, of which g++ 12 makes no vectors here.
  for (int i = 0; i < kCandidates; ++i) {
    const Sum differs = smaller(static_cast<Sum>(sums[i] - smallest), 1);
    first = smaller(first, static_cast<Sum>(kPlaces.at[i] | static_cast<Sum>(-differs)));
  }
  const Sum* const out = kThreeSumsOut.sums + kMaxCandidates - first;
  for (int i = 0; i < kCandidates; ++i)
    second = smaller(second, static_cast<Sum>(sums[i] | out[i]));
  return {first, smallest, second};
}

// The mean over a window of `area` pixels, rounded.
constexpr std::uint8_t mean_cost(Sum sum, int area) {
  return static_cast<std::uint8_t>((sum * kMeanCostSteps + area / 2) / area);
}

// The winner of pixel x from the sums of its windows, which have `area` pixels.
template <int kCandidates>
[[gnu::always_inline]] inline void find_winner(const Sum* sums, int area, int x,
                                               const WinnerPointers& out) {
  const BestSum best = best_of<kCandidates>(sums);
  out.candidate[x] = static_cast<std::uint8_t>(best.candidate);
  out.cost[x] = mean_cost(best.sum, area);
  out.second[x] = mean_cost(best.second, area);
}

template <int kCandidates>
void choose_row(const ChoiceRow& row, const WinnerPointers& out) {
  for (int x = 0; x < row.width_px; ++x) {
    const Sum* const before = row.before[row.arm_up[x]] + x * kCandidates;
    const Sum* const after = row.after[row.arm_down[x]] + x * kCandidates;
    Sum sums[kCandidates];
    for (int i = 0; i < kCandidates; ++i) sums[i] = static_cast<Sum>(after[i] - before[i]);
    find_winner<kCandidates>(sums, row.area[x], x, out);
  }
}

template <int kCandidates>
void sum_boxes(const BoxRow& row) {
  const std::uint8_t *const entering = row.entering, *const leaving = row.leaving;
  Sum* __restrict const column = row.column;
  const int last = row.width_px - 1;
  for (int i = 0; i < row.width_px * kCandidates; ++i)
    column[i] = static_cast<Sum>(column[i] + entering[i] - leaving[i]);
  const auto column_at = [&](int x) {
    return column + (x < 0 ? 0 : (x > last ? last : x)) * kCandidates;
  };
  Sum sum[kCandidates] = {};
  const auto change = [&](const Sum* added, const Sum* taken) {
    for (int i = 0; i < kCandidates; ++i) sum[i] = static_cast<Sum>(sum[i] + added[i] - taken[i]);
  };
  constexpr Sum kNothing[kCandidates] = {};
  for (int dx = -row.half_px; dx <= row.half_px; ++dx) change(column_at(dx), kNothing);
  for (int x = 0; x <= last; ++x) {
    Sum* __restrict const box = row.box + x * kCandidates;
    for (int i = 0; i < kCandidates; ++i) box[i] = sum[i];
    change(column_at(x + row.half_px + 1), column_at(x - row.half_px));
  }
}

constexpr Sum larger(Sum a, Sum b) { return a < b ? b : a; }
constexpr Sum sum_of(Sum a, Sum b) { return static_cast<Sum>(a + b); }

struct FourSums {
  Sum a, b, c, d;  // from the smallest
};

[[gnu::always_inline]] inline FourSums sorted(Sum a, Sum b, Sum c, Sum d) {
  const Sum ab = smaller(a, b), ba = larger(a, b), cd = smaller(c, d), dc = larger(c, d);
  const Sum one = larger(ab, cd), other = smaller(ba, dc);
  return {smaller(ab, cd), smaller(one, other), larger(one, other), larger(ba, dc)};
}

[[gnu::always_inline]] inline Sum best_two(Sum a, Sum b, Sum c, Sum d) {
  return smaller(smaller(sum_of(a, b), sum_of(c, d)), sum_of(smaller(a, b), smaller(c, d)));
}

// Of two sorted fours those below the middle are the smaller ones of the pairs that lie as far from
// opposite ends.
[[gnu::always_inline]] inline Sum best_four(FourSums p, FourSums q) {
  return sum_of(sum_of(smaller(p.a, q.d), smaller(p.b, q.c)),
                sum_of(smaller(p.c, q.b), smaller(p.d, q.a)));
}

// The better half of the sums of candidate i.
template <NeighbourWindows kNeighbours>
[[gnu::always_inline]] inline Sum support(const Sum* const (&at)[8], int i) {
  if constexpr (kNeighbours == NeighbourWindows::none) return 0;
  if constexpr (kNeighbours == NeighbourWindows::four)
    return best_two(at[0][i], at[1][i], at[2][i], at[3][i]);
  return best_four(sorted(at[0][i], at[1][i], at[2][i], at[3][i]),
                   sorted(at[4][i], at[5][i], at[6][i], at[7][i]));
}

template <int kCandidates, NeighbourWindows kNeighbours>
void choose_supported(const SupportedRow& row, const WinnerPointers& out) {
  const Sum *const above = row.boxes[0], *const here = row.boxes[1], *const below = row.boxes[2];
  for (int x = 0; x < row.width_px; ++x) {
    const int last = row.width_px - 1, middle = x * kCandidates;
    const int left = (x < row.half_px ? 0 : x - row.half_px) * kCandidates;
    const int right = (x + row.half_px > last ? last : x + row.half_px) * kCandidates;
    const Sum* const at[] = {above + left,   above + right,  below + left, below + right,
                             above + middle, below + middle, here + left,  here + right};
    Sum sums[kCandidates];
    for (int i = 0; i < kCandidates; ++i)
      sums[i] = sum_of(here[middle + i], support<kNeighbours>(at, i));
    find_winner<kCandidates>(sums, row.area, x, out);
  }
}

template <NeighbourWindows kNeighbours>
constexpr std::array<WindowKernels::ChooseSupported, WindowKernels::kSizes> supported_choices() {
  return {choose_supported<32, kNeighbours>,  choose_supported<64, kNeighbours>,
          choose_supported<96, kNeighbours>,  choose_supported<128, kNeighbours>,
          choose_supported<160, kNeighbours>, choose_supported<192, kNeighbours>,
          choose_supported<224, kNeighbours>, choose_supported<256, kNeighbours>};
}

// Even is for numbers of candidates that are even multiples of kCandidateStep, Odd for the others.
template <class Odd, class Even = Odd>
constexpr WindowKernels make_window_kernels() {
  return {
      .census = census_row<Even>,
      .arms = grow_arms<Even>,
      .gather = {gather_row<Odd, 32>, gather_row<Even, 64>, gather_row<Odd, 96>,
                 gather_row<Even, 128>, gather_row<Odd, 160>, gather_row<Even, 192>,
                 gather_row<Odd, 224>, gather_row<Even, 256>},
      .choose = {choose_row<32>, choose_row<64>, choose_row<96>, choose_row<128>, choose_row<160>,
                 choose_row<192>, choose_row<224>, choose_row<256>},
      .costs = {cost_row<Odd, 32>, cost_row<Even, 64>, cost_row<Odd, 96>, cost_row<Even, 128>,
                cost_row<Odd, 160>, cost_row<Even, 192>, cost_row<Odd, 224>, cost_row<Even, 256>},
      .sum_boxes = {sum_boxes<32>, sum_boxes<64>, sum_boxes<96>, sum_boxes<128>, sum_boxes<160>,
                    sum_boxes<192>, sum_boxes<224>, sum_boxes<256>},
      .choose_supported = {supported_choices<NeighbourWindows::none>(),
                           supported_choices<NeighbourWindows::four>(),
                           supported_choices<NeighbourWindows::eight>()}};
}

}  // namespace
}  // namespace stereovox
// NOLINTEND(misc-definitions-in-headers)
