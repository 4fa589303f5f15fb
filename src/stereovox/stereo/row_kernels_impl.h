// The loops of row_kernels.h, included by one file for each kind of machine. They stay plain: the
// compiler makes vectors of them.
#pragma once

#include <cstddef>

#include "stereovox/stereo/row_kernels.h"

// Each including file is to have its own: NOLINTBEGIN(misc-definitions-in-headers)
namespace stereovox {
namespace {

using Step = std::int16_t;

template <class T>
[[gnu::always_inline]] constexpr T smaller(T a, T b) {
  return b < a ? b : a;
}
template <class T>
[[gnu::always_inline]] constexpr T larger(T a, T b) {
  return a < b ? b : a;
}

// One of two by a mask that has all bits or none.
[[gnu::always_inline]] constexpr int select(int mask, int yes, int no) {
  return no ^ ((yes ^ no) & mask);
}

void choose_winners(const ChoiceCosts& costs, int width_px, const ChosenRow& row) {
  const ChoiceCosts from = costs;
  const ChosenRow to = row;
#pragma GCC ivdep
  for (int u = 0; u < width_px; ++u) {
    const auto byte = [&](int i) { return static_cast<int>(from.four[u] >> 8 * i & 255U); };
    const int a = byte(0), b = byte(1), c = byte(2), d = byte(3), e = from.fifth[u];
    const int on = -static_cast<int>(d < smaller(b, c)), back = -static_cast<int>(b < c) & ~on;
    to.candidate[u] = static_cast<std::uint8_t>(to.candidate[u] - on + back);
    to.before[u] = static_cast<std::uint8_t>(select(on, c, select(back, a, b)));
    to.here[u] = static_cast<std::uint8_t>(smaller(smaller(b, c), d));
    to.after[u] = static_cast<std::uint8_t>(select(on, e, select(back, c, d)));
  }
}

void fill_disparities(const LocalRow& row, int width_px, int max_disparity_px,
                      Step* __restrict out) {
  constexpr int kHalf = kStepsPerPixel / 2;
  const LocalRow r = row;
  for (int u = 0; u < width_px; ++u) {
    const int cost = r.here[u], before = r.before[u], after = r.after[u];
    const int bend = before + after - 2 * cost;
    const bool has_vertex = (before != kNoLocalCost) & (after != kNoLocalCost) & (before >= cost) &
                            (after >= cost) & (bend > 0);
    const float shift =
        static_cast<float>(kHalf * (before - after)) / static_cast<float>(larger(bend, 1));
    constexpr float kRounding = 0.5F;
    const int rounded = static_cast<int>(shift + (kHalf + kRounding)) - kHalf;
    out[u] = static_cast<Step>((max_disparity_px - r.candidate[u]) * kStepsPerPixel -
                               rounded * static_cast<int>(has_vertex));
  }
}

void fill_left_right(const OwnedRow& row, int width_px, std::uint8_t* __restrict out) {
  const OwnedRow r = row;
  const auto difference = [](int here, std::uint32_t owner) {
    const int there = static_cast<std::uint16_t>(owner) + kSmallestDisparity;
    return larger(here - there, there - here);
  };
  for (int u = 0; u < width_px; ++u) {
    const int here = r.disparity[u], candidate = r.candidate[u];
    const int whole = (r.max_disparity_px - candidate) * kStepsPerPixel;
    const std::uint32_t pair = r.owners[u + candidate - static_cast<int>(here > whole)];
    const int smallest = smaller(difference(here, pair), difference(here, pair >> kDisparityBits));
    out[u] = static_cast<std::uint8_t>(smaller(smallest, r.max_difference));
  }
}

void add_along_surface(const std::uint8_t* cost, int candidates, const std::uint8_t* winner,
                       int width_px, int step, std::uint16_t* sum) {
  for (int x = 0; x < width_px; x += step) {
    const std::uint8_t* const from = cost + static_cast<std::ptrdiff_t>(x) * candidates;
    std::uint16_t* const to = sum + candidates - winner[x];
#pragma GCC ivdep
    for (int c = 0; c < candidates; ++c) to[c] = static_cast<std::uint16_t>(to[c] + from[c]);
  }
}

// The middle one of three.
[[gnu::always_inline]] inline Step middle(Step a, Step b, Step c) {
  return larger(smaller(a, b), smaller(larger(a, b), c));
}

// Small enough for the compiler to see what overlaps nothing.
inline void sort_inner_columns(const Step* above, const Step* here, const Step* below, int width_px,
                               Step* __restrict low, Step* __restrict mid, Step* __restrict high) {
  for (int u = 0; u < width_px; ++u) {
    const Step a = above[u], b = here[u], c = below[u];
    low[u] = smaller(a, smaller(b, c));
    mid[u] = middle(a, b, c);
    high[u] = larger(a, larger(b, c));
  }
}

void sort_columns(const Step* above, const Step* here, const Step* below, int width_px,
                  const SortedRows& out) {
  sort_inner_columns(above, here, below, width_px, out.low + 1, out.mid + 1, out.high + 1);
  for (Step* const row : {out.low, out.mid, out.high}) {
    row[0] = row[1];
    row[width_px + 1] = row[width_px];
  }
}

void fill_medians(const SortedRows& rows, int width_px, Step* __restrict out) {
  const Step *const l = rows.low, *const m = rows.mid, *const h = rows.high;
  for (int u = 0; u < width_px; ++u)
    out[u] = middle(larger(l[u], larger(l[u + 1], l[u + 2])), middle(m[u], m[u + 1], m[u + 2]),
                    smaller(h[u], smaller(h[u + 1], h[u + 2])));
}

// The step from `here` to `there`, or none when they belong to different surfaces. Steps wrap
// around, but never to small ones: disparities have 15 bits.
[[gnu::always_inline]] inline Step step_on_surface(Step here, Step there) {
  const auto step = static_cast<Step>(there - here);
  return step <= kStepsPerPixel && step >= -kStepsPerPixel ? step : Step{0};
}

// Rounded to the nearest.
[[gnu::always_inline]] inline Step mean_step(Step sum) {
  constexpr int kBits = 16, kReciprocal = ((1 << kBits) + kSmoothMembers / 2) / kSmoothMembers;
  return static_cast<Step>((sum * kReciprocal + (1 << (kBits - 1))) >> kBits);
}

void fill_means(const Step* const* members, int width_px, Step* __restrict out) {
  const Step* const own = members[kSmoothReach_px];
  const Step* rows[kSmoothMembers];
  for (int k = 0; k < kSmoothMembers; ++k) rows[k] = members[k];
  for (int u = 0; u < width_px; ++u) {
    Step sum = 0;
    for (int k = 0; k < kSmoothMembers; ++k)
      sum = static_cast<Step>(sum + step_on_surface(own[u], rows[k][u]));
    out[u] = static_cast<Step>(own[u] + mean_step(sum));
  }
}

// Pixels that lie side by side, or what is true (all bits) or false (0) of each.
constexpr int kLanes = 16;
using Lanes = Step __attribute__((vector_size(kLanes * sizeof(Step))));
using GrayLanes = std::uint8_t __attribute__((vector_size(kLanes)));

template <class Vector, class T>
[[gnu::always_inline]] inline Vector load(const T* from) {
  Vector lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

[[gnu::always_inline]] inline bool is_any(const Lanes& mask) {
  std::uint64_t words[sizeof(Lanes) / sizeof(std::uint64_t)], any = 0;
  __builtin_memcpy(words, &mask, sizeof(words));
  for (const std::uint64_t word : words) any |= word;
  return any != 0;
}

constexpr int kWindow = kMedianSide_px * kMedianSide_px;
constexpr Step kMinSpan = kStepsPerPixel + kStepsPerPixel / 2;  // of an edge
constexpr Step kNoStep = 32767;

// The smallest and the largest disparity in the windows about the pixels from `first` on.
[[gnu::always_inline]] inline void find_spans(const MedianRows& rows, int first, Lanes& low,
                                              Lanes& high) {
  Step lowest[2 * kLanes], highest[2 * kLanes];  // of the columns
  for (int part = 0; part < 2 * kLanes; part += kLanes) {
    Lanes least = Lanes{} + kNoStep, most = {};
    for (int k = 0; k < kMedianSide_px; ++k) {
      const auto d = load<Lanes>(rows.disparity[k] + first + part);
      const Lanes or_none = d > 0 ? d : Lanes{} + kNoStep;
      least = or_none < least ? or_none : least;
      most = d > most ? d : most;
    }
    __builtin_memcpy(lowest + part, &least, sizeof(least));
    __builtin_memcpy(highest + part, &most, sizeof(most));
  }
  low = load<Lanes>(lowest), high = load<Lanes>(highest);
  for (int dx = 1; dx < kMedianSide_px; ++dx) {
    const auto least = load<Lanes>(lowest + dx), most = load<Lanes>(highest + dx);
    low = least < low ? least : low;
    high = most > high ? most : high;
  }
}

// Of each of those pixels, the weights in its window, and their sum.
[[gnu::always_inline]] inline Lanes weigh(const MedianRows& rows, int first,
                                          Lanes (&weight)[kWindow]) {
  const auto gray_at = [&](int k, int dx) {
    return __builtin_convertvector(load<GrayLanes>(rows.gray[k] + first + dx), Lanes);
  };
  const Lanes own = gray_at(kMedianReach_px, kMedianReach_px);
  const Lanes contrast = Lanes{} + static_cast<Step>(rows.contrast_gray);
  Lanes total = {};
  Lanes* next = weight;
  for (int k = 0; k < kMedianSide_px; ++k)
    for (int dx = 0; dx < kMedianSide_px; ++dx) {
      const Lanes rise = gray_at(k, dx) - own;
      const Lanes alike = contrast - (rise > 0 ? rise : -rise);
      const Lanes counts = (alike > 0) & (load<Lanes>(rows.disparity[k] + first + dx) > 0);
      *next = alike & counts;
      total += *next++;
    }
  return total;
}

// Halves the spans that hold the medians until nothing is left of them.
[[gnu::always_inline]] inline Lanes find_medians(const MedianRows& rows, int first, Lanes low,
                                                 Lanes high) {
  Lanes weight[kWindow];
  const Lanes total = weigh(rows, first, weight);
  while (is_any(low < high)) {
    const Lanes middle = low + ((high - low) >> 1);
    Lanes below = {};
    const Lanes* next = weight;
    for (const std::int16_t* const disparity : rows.disparity)
      for (int dx = 0; dx < kMedianSide_px; ++dx)
        below += *next++ & (load<Lanes>(disparity + first + dx) <= middle);
    const Lanes is_below = below + below >= total;
    high = is_below ? middle : high;
    low = is_below ? low : middle + 1;
  }
  return low;
}

void settle_edges(const MedianRows& rows, int width_px, Step* __restrict out) {
  for (int first = 0; first < width_px; first += kLanes) {
    Lanes low, high;
    find_spans(rows, first, low, high);
    const Step* const own = rows.disparity[kMedianReach_px] + first + kMedianReach_px;
    const Lanes is_edge = (load<Lanes>(own) > 0) & (high - (low & (high > 0)) > kMinSpan);
    if (!is_any(is_edge)) continue;
    const Lanes median = find_medians(rows, first, low & is_edge, high & is_edge);
    for (int x = 0; x < smaller(kLanes, width_px - first); ++x)
      out[first + x] = is_edge[x] != 0 ? median[x] : own[x];
  }
}

// Variances are summed over steps of this many smaller ones: their squares then fit 32 bits.
constexpr int kCoarse = 8;

void fill_moments(const Step* const* disparity, int width_px, std::uint32_t* __restrict sum,
                  std::uint32_t* __restrict square_sum) {
  const Step* rows[kVarianceSide_px];
  for (int k = 0; k < kVarianceSide_px; ++k) rows[k] = disparity[k];
  for (int u = 0; u < width_px; ++u) {
    std::int32_t coarse_sum = 0;
    std::uint32_t squares = 0;
    for (int k = 0; k < kVarianceSide_px; ++k) {
      const Step coarse = static_cast<Step>(rows[k][u] / kCoarse);
      coarse_sum += coarse;
      squares += static_cast<std::uint32_t>(coarse * coarse);
    }
    sum[u] = static_cast<std::uint32_t>(coarse_sum);
    square_sum[u] = squares;
  }
}

void fill_variances(const std::uint32_t* sums, const std::uint32_t* squares, int width_px,
                    float* __restrict variance_px2) {
  constexpr int kArea = kVarianceSide_px * kVarianceSide_px;
  constexpr float kCoarsePerPixel = static_cast<float>(kStepsPerPixel) / kCoarse;
  constexpr float kToVariance = 1.0F / (kArea * kArea * kCoarsePerPixel * kCoarsePerPixel);
  for (int u = 0; u < width_px; ++u) {
    std::uint32_t sum = 0, square_sum = 0;
    for (int k = 0; k < kVarianceSide_px; ++k) {
      sum += sums[u + k];
      square_sum += squares[u + k];
    }
    variance_px2[u] =
        kToVariance * static_cast<float>(static_cast<std::int32_t>(kArea * square_sum - sum * sum));
  }
}

// log2(1 + variance) by straight lines between powers of two, as the bits of a float have it. Here
// and below integers are limited, not floats: the compiler makes no vectors of those.
[[gnu::always_inline]] inline float log_of_raised(float variance_px2) {
  constexpr float kOnePerOctave = 0x1p-23F;
  const auto bits_of = [](float x) { return __builtin_bit_cast(std::int32_t, x); };
  const std::int32_t bits = smaller(bits_of(1.0F + variance_px2), bits_of(1.0F + kMaxVariance_px2));
  return kOnePerOctave * static_cast<float>(bits - bits_of(1.0F));
}

void fill_levels(const LevelRow& row, int width_px, std::uint8_t* __restrict out) {
  const LevelRow r = row;
  for (int u = 0; u < width_px; ++u) {
    const float sum = r.bias + r.of_log_ratio * static_cast<float>(r.log_ratio[u]) +
                      r.of_left_right * static_cast<float>(r.left_right[u]) +
                      r.of_variance * log_of_raised(r.variance_px2[u]) +
                      r.of_local_cost * static_cast<float>(r.local_cost[u]);
    out[u] = static_cast<std::uint8_t>(smaller(larger(static_cast<int>(sum), 0), r.max_level));
  }
}

constexpr int kSaturated_gray = 255;

void judge_row(const JudgedRow& row, int width_px, Step* __restrict passed,
               std::uint8_t* __restrict is_sure) {
  const JudgedRow r = row;
  for (int u = 0; u < width_px; ++u) {
    const int darkest = smaller(smaller(r.gray_above[u], r.gray_below[u]), r.gray[u]);
    const bool passes = (r.disparity[u] > 0) & (r.log_ratio[u] >= r.min_log_ratio) &
                        (r.left_right[u] <= r.max_left_right) & (r.level[u] >= r.min_level) &
                        (darkest < kSaturated_gray);
    passed[u] = passes ? r.disparity[u] : Step{0};
    is_sure[u] = static_cast<std::uint8_t>(r.level[u] >= r.sure_level);
  }
}

void keep_seen(int width_px, Step* __restrict passed) {
  constexpr int kHalf = kStepsPerPixel / 2;
  for (int u = 0; u < width_px; ++u)
    passed[u] = u * kStepsPerPixel + kHalf > passed[u] ? passed[u] : Step{0};
}

constexpr RowKernels kRowKernels = {.choose = choose_winners,
                                    .disparities = fill_disparities,
                                    .left_right = fill_left_right,
                                    .along_surface = add_along_surface,
                                    .sort_columns = sort_columns,
                                    .medians = fill_medians,
                                    .means = fill_means,
                                    .edge_medians = settle_edges,
                                    .moments = fill_moments,
                                    .variances = fill_variances,
                                    .levels = fill_levels,
                                    .judge = judge_row,
                                    .keep_seen = keep_seen};

}  // namespace
}  // namespace stereovox
// NOLINTEND(misc-definitions-in-headers)
