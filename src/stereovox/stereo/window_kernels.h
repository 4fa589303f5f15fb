// The inner loops of the adaptive windows, compiled for AVX2, for AVX-512 and for any machine; all
// give the same bytes. Candidates are those of census_kernels.h, and so is the rule about plain
// pointers.
#pragma once

#include <array>
#include <cstdint>

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

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
  const std::uint16_t* area = nullptr;  // pixels of each window
};

// Costs summed over squares of 2 half_px + 1 rows and columns, from those of the row above: one row
// of costs enters the columns, another leaves them. Beyond the image columns are those at its edge.
struct BoxRow {
  int width_px = 0, half_px = 0;
  const std::uint8_t *entering = nullptr, *leaving = nullptr;
  std::uint16_t* column = nullptr;  // width x candidates: sums over the rows of a square
  std::uint16_t* box = nullptr;     // the same over whole squares
};

// The squares besides the one about a pixel: none, those half_px away on its diagonals, or these
// and those half_px beside, above and below it.
enum class NeighbourWindows { none, four, eight };
inline constexpr int kNeighbourhoods = 3;
constexpr int number_of(NeighbourWindows neighbours) { return 4 * static_cast<int>(neighbours); }
// Of the neighbours the better half counts. The sums have 16 bits, and one value means nothing.
inline constexpr int kMaxWindowHalf_px = 10;
static_assert((1 + number_of(NeighbourWindows::eight) / 2) * (2 * kMaxWindowHalf_px + 1) *
                  (2 * kMaxWindowHalf_px + 1) * kMaxMatchingCost <
              (1 << 16) - 1);

// The row whose winners are looked for by squares that support each other.
struct SupportedRow {
  int width_px = 0, half_px = 0;
  // Sums about the pixels half_px above, in, and half_px below this row: width x candidates.
  std::array<const std::uint16_t*, 3> boxes = {};
  int area = 0;  // pixels of all squares that count
};

// Functions that depend on the number of candidates are listed by candidates / kCandidateStep - 1.
struct WindowKernels {
  static constexpr int kSizes = CensusKernels::kSizes;
  using Arms = void (*)(const ArmRow& row, std::uint8_t* out);
  using Gather = void (*)(const GatherRow& row);
  using Choose = void (*)(const ChoiceRow& row, const WinnerPointers& out);
  using Costs = void (*)(const CostRow& row);
  using SumBoxes = void (*)(const BoxRow& row);
  using ChooseSupported = void (*)(const SupportedRow& row, const WinnerPointers& out);

  CensusKernels::Census census = nullptr;
  Arms arms = nullptr;
  std::array<Gather, kSizes> gather = {};
  // The costs of a winner are means over its window in parts of a bit, kMeanCostSteps.
  std::array<Choose, kSizes> choose = {};
  std::array<Costs, kSizes> costs = {};
  std::array<SumBoxes, kSizes> sum_boxes = {};
  std::array<std::array<ChooseSupported, kSizes>, kNeighbourhoods> choose_supported = {};
};

const WindowKernels& portable_window_kernels();
const WindowKernels* avx2_window_kernels();    // nullptr on a machine without AVX2
const WindowKernels* avx512_window_kernels();  // or without AVX-512 BW, VL, VBMI and BITALG
const WindowKernels& fastest_window_kernels();

}  // namespace stereovox
