// The inner loops of the adaptive windows, compiled for AVX2 and for any machine; all give the same
// bytes. Candidates are those of census_kernels.h, and so is the rule about plain pointers.
#pragma once

#include <array>
#include <cstdint>

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

inline constexpr int kMaxMatchingCost =
    26;  // the mean of kCensusBits and kMaxSlopeCost, rounded up
// Sums over windows have 16 bits, which wrap around only above windows of this reach.
inline constexpr int kMaxArm_px = 24;
static_assert((2 * kMaxArm_px + 1) * (2 * kMaxArm_px + 1) * kMaxMatchingCost < 1 << 16);
// Winners carry the mean costs of their windows in these parts of a census bit.
inline constexpr int kMeanCostSteps = 8;
static_assert(kMeanCostSteps * kMaxMatchingCost < kNoLocalCost);

// The bytes at `from` are compared with those at from + k step, k = 1 ... max_arm_px: the arm ends
// before the first that differs by more than contrast_gray. Bytes that far away must be readable.
struct ArmRow {
  const std::uint8_t* from = nullptr;
  std::ptrdiff_t step = 0;
  int width_px = 0, max_arm_px = 0;
  std::uint8_t contrast_gray = 0;
};

// One row of images that the windows have reached: what the horizontal arms of its pixels gather.
struct GatherRow {
  int width_px = 0;
  PixelRow left, right;  // candidate i of left pixel x is right pixel x + i
  const std::uint8_t *arm_left = nullptr, *arm_right = nullptr;
  std::uint8_t* cost = nullptr;          // memory for width x candidates costs
  std::uint16_t* along = nullptr;        // memory for (width + 1) x candidates sums
  const std::uint16_t* above = nullptr;  // width x candidates: sums of all rows above this one
  std::uint16_t* below = nullptr;        // the same with this one
};

// The row whose winners are looked for. A pixel with the arm k upwards starts its window with the
// sums before[k], and with the arm k downwards ends it with after[k].
struct ChoiceRow {
  int width_px = 0;
  const std::uint8_t *arm_up = nullptr, *arm_down = nullptr;
  std::array<const std::uint16_t*, kMaxArm_px + 1> before = {}, after = {};  // width x candidates
  std::uint8_t* cost = nullptr;         // what was gathered of the row
  const std::uint16_t* area = nullptr;  // pixels of each window
};

// Functions that depend on the number of candidates are listed by candidates / kCandidateStep - 1.
struct WindowKernels {
  static constexpr int kSizes = CensusKernels::kSizes;
  using Arms = void (*)(const ArmRow& row, std::uint8_t* out);
  using Gather = void (*)(const GatherRow& row);
  using Choose = void (*)(const ChoiceRow& row, const WinnerPointers& out);

  CensusKernels::Census census = nullptr;
  Arms arms = nullptr;
  std::array<Gather, kSizes> gather = {};
  // The costs of a winner are means over its window in parts of a bit, kMeanCostSteps. Where a
  // surface leans, its window is right for its middle only: so local costs choose among neighbours.
  std::array<Choose, kSizes> choose = {};
};

const WindowKernels& portable_window_kernels();
const WindowKernels* avx2_window_kernels();  // nullptr on a machine without AVX2
const WindowKernels& fastest_window_kernels();

}  // namespace stereovox
