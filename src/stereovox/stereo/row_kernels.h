// The loops over the pixels of a row that follow the search of a census matcher, compiled for AVX2,
// for AVX-512 and for any machine from the same plain code; all give the same bytes. The rule about
// plain pointers is that of census_kernels.h.
#pragma once

#include <cstdint>

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

// Between the stages of a matcher disparities are whole steps of this part of a pixel.
inline constexpr int kStepsPerPixel = 32;

// Disparities are averaged over this many pixels either way: see smooth_disparities.h.
inline constexpr int kSmoothReach_px = 4, kSmoothMembers = 2 * kSmoothReach_px + 1;
// Medians about edges are those of a square with this side; see edge_medians.h.
inline constexpr int kMedianReach_px = 3, kMedianSide_px = 2 * kMedianReach_px + 1;
inline constexpr int kMedianSlack = 32;  // the rows of the square go on for so long
// The variance of disparities is that of a square with this side.
inline constexpr int kVarianceSide_px = 5;
inline constexpr float kMaxVariance_px2 = 400.0F;

// The three rows about one, sorted column by column, with one more column on either side.
struct SortedRows {
  std::int16_t *low = nullptr, *mid = nullptr, *high = nullptr;
};

// What the confidence of a row's pixels is made of, and what each weighs: see match_confidence.h.
struct LevelRow {
  const std::uint8_t *log_ratio = nullptr, *left_right = nullptr, *local_cost = nullptr;
  const float* variance_px2 = nullptr;
  float bias = 0, of_log_ratio = 0, of_left_right = 0, of_local_cost = 0, of_variance = 0;
  int max_level = 0;
};

// The rows about one; the first entry of each lies kMedianReach_px before its first pixel.
struct MedianRows {
  const std::int16_t* disparity[kMedianSide_px] = {};
  const std::uint8_t* gray[kMedianSide_px] = {};
  int contrast_gray = 0;
};

// The winners of a row and the local costs of them and their neighbours: see WinnerRow.
struct LocalRow {
  const std::uint8_t *candidate = nullptr, *before = nullptr, *here = nullptr, *after = nullptr;
};

// The local costs of the five candidates about each winner, the first one lowest in `four`.
inline constexpr int kChoiceReach = 2;
struct ChoiceCosts {
  const std::uint32_t* four = nullptr;
  const std::uint8_t* fifth = nullptr;
};
struct ChosenRow {
  std::uint8_t *candidate = nullptr, *before = nullptr, *here = nullptr, *after = nullptr;
};

// What a row of matches is compared with: who matches each right pixel and the one beside it best,
// as their disparities, counted from the smallest that 16 bits hold, the first in the lower bits.
inline constexpr int kDisparityBits = 16, kSmallestDisparity = -(1 << (kDisparityBits - 1));
struct OwnedRow {
  const std::uint8_t* candidate = nullptr;
  const std::int16_t* disparity = nullptr;
  const std::uint32_t* owners = nullptr;         // of the right pixel of candidate 0 of pixel 0
  int max_disparity_px = 0, max_difference = 0;  // the difference in steps
};

// What is known of a row's matches, and what of it is enough: see judge_matches.h.
struct JudgedRow {
  const std::int16_t* disparity = nullptr;
  // Brightness of this row of the left image and of those beside it. Where all three are as bright
  // as can be, there is light but no picture.
  const std::uint8_t *gray_above = nullptr, *gray = nullptr, *gray_below = nullptr;
  const std::uint8_t *log_ratio = nullptr, *left_right = nullptr, *level = nullptr;
  int min_log_ratio = 0, max_left_right = 0, min_level = 0, sure_level = 0;
};

struct RowKernels {
  // Moves winners to the best of them and their two neighbours: see winner_row.h.
  using Choose = void (*)(const ChoiceCosts& costs, int width_px, const ChosenRow& row);
  // Vertices of the parabolas through the local costs, in steps.
  using Disparities = void (*)(const LocalRow& row, int width_px, int max_disparity_px,
                               std::int16_t* out);
  // How far disparities are from that of the owner of either right pixel that they end between.
  using LeftRight = void (*)(const OwnedRow& row, int width_px, std::uint8_t* out);
  // Adds the costs of every `step`th of the pixels, candidate c of each at candidates + c - winner.
  using AlongSurface = void (*)(const std::uint8_t* cost, int candidates,
                                const std::uint8_t* winner, int width_px, int step,
                                std::uint16_t* sum);
  using SortColumns = void (*)(const std::int16_t* above, const std::int16_t* here,
                               const std::int16_t* below, int width_px, const SortedRows& out);
  using Medians = void (*)(const SortedRows& rows, int width_px, std::int16_t* out);
  // Means over those of kSmoothMembers rows that lie on the surface of the middle one.
  using Means = void (*)(const std::int16_t* const* members, int width_px, std::int16_t* out);
  // Writes what becomes of pixels at edges; others that it writes stay as they are.
  using EdgeMedians = void (*)(const MedianRows& rows, int width_px, std::int16_t* out);
  // Sums of the disparities of kVarianceSide_px rows and of their squares, which may wrap around.
  using Moments = void (*)(const std::int16_t* const* rows, int width_px, std::uint32_t* sum,
                           std::uint32_t* square_sum);
  // From the moments of columns, two more at either end.
  using Variances = void (*)(const std::uint32_t* sum, const std::uint32_t* square_sum,
                             int width_px, float* variance_px2);
  using Levels = void (*)(const LevelRow& row, int width_px, std::uint8_t* out);
  // Disparities > 0 that pass, or 0; and 1 where a level reaches sure_level, else 0.
  using Judge = void (*)(const JudgedRow& row, int width_px, std::int16_t* passed,
                         std::uint8_t* is_sure);
  // Sets disparities to 0 that lead beyond the left end of the right row.
  using KeepSeen = void (*)(int width_px, std::int16_t* passed);

  Choose choose = nullptr;
  Disparities disparities = nullptr;
  LeftRight left_right = nullptr;
  AlongSurface along_surface = nullptr;
  SortColumns sort_columns = nullptr;
  Medians medians = nullptr;
  Means means = nullptr;
  EdgeMedians edge_medians = nullptr;
  Moments moments = nullptr;
  Variances variances = nullptr;
  Levels levels = nullptr;
  Judge judge = nullptr;
  KeepSeen keep_seen = nullptr;
};

const RowKernels& portable_row_kernels();
const RowKernels* avx2_row_kernels();    // nullptr on a machine without AVX2
const RowKernels* avx512_row_kernels();  // nullptr on a machine without AVX-512 BW, VL and DQ
const RowKernels& fastest_row_kernels();

}  // namespace stereovox
