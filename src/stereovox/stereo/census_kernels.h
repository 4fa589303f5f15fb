// The inner loops of the census matchers, compiled for AVX2, for AVX-512 and for any machine;
// all give the same bytes. Plain pointers throughout, so that the code for one machine shares
// nothing that a linker could mistake for code for every machine.
//
// A candidate i = 0 ... candidates - 1 of left pixel x stands for disparity max_disparity - i: then
// the right pixels of consecutive candidates lie side by side.
#pragma once

#include <array>
#include <cstdint>

namespace stereovox {

inline constexpr int kCensusPlanes = 4;
inline constexpr int kSlopePlane = kCensusPlanes, kPlanes = kCensusPlanes + 1;
inline constexpr int kCensusHalfWidth_px = 4, kCensusHalfHeight_px = 3;
inline constexpr int kCandidateStep = 32, kMaxCandidates = 256;
inline constexpr int kCensusBits = 31;
// The change of brightness along the row counts up to kMaxSlope_gray; how much it differs weighs
// this much, up to kMaxSlopeCost, against census bits. Census alone confuses fine structures, and
// before mirrors and other weak texture it misses edges, because it does not see how strong they
// are. The cost is three quarters of the mean of both, rounded up: windows sum it in 16 bits.
inline constexpr int kMaxSlope_gray = 40, kSlopeWeight = 4, kMaxSlopeCost = 40;
inline constexpr int kMaxMatchingCost = 27;  // of kCensusBits and kMaxSlopeCost
inline constexpr int kLocalWidth_px = 5;
inline constexpr std::uint8_t kNoLocalCost = 255;
// Rows of bytes may be read and written this far beyond their end.
inline constexpr int kRowSlack = 64;

// What pixels of one image row are compared by, byte by byte. The centre-symmetric census: bit b of
// plane p says whether pixel k = 8 p + b of the upper half of a 9 x 7 window is at least as bright
// as its mirror image in the lower half. And the clipped slope of the brightness, plus 128.
struct PixelRow {
  std::array<std::uint8_t*, kPlanes> planes = {};
};

// The penalty for a disparity jump by the brightness step between two pixels; larger steps count as
// the last one.
inline constexpr int kPenaltySteps = 64;
using PenaltyTable = std::array<std::uint8_t, kPenaltySteps>;

// Penalties for a disparity jump between each pixel of a row and the one before it, and the ones
// above, above to the left, above to the right.
struct PenaltyRows {
  std::uint8_t* beside = nullptr;
  std::array<std::uint8_t*, 3> above = {};
};

struct CostRow {
  int width_px = 0;
  PixelRow left, right;          // candidate i of left pixel x is right pixel x + i
  std::uint8_t* cost = nullptr;  // memory for width x candidates costs
};

// One row of images that semi-global aggregation has reached, and what it keeps from row to row.
struct SweepRow {
  int width_px = 0;
  PixelRow left, right;  // candidate i of left pixel x is right pixel x + i
  std::uint8_t small_penalty = 0;
  std::uint8_t nearer_penalty = 0;  // of the paths from above, to a disparity one larger
  PenaltyRows penalty;
  // Path costs above their minimum, width x candidates, for the three paths from above. Row y keeps
  // pixel x in slot (first_slot + x) mod width: chosen so that the pixel that a path comes from
  // lies in the same slot, and is overwritten where it is read.
  std::array<std::uint8_t*, 3> paths_above = {};
  std::array<int, 3> first_slot = {};
  std::uint8_t* cost = nullptr;  // width x candidates
  std::uint8_t* sum = nullptr;   // width x candidates: of path costs, at most 255
};

// What the best candidate of each pixel of a row is, the first one of equals.
struct WinnerPointers {
  std::uint8_t* candidate = nullptr;
  std::uint8_t* cost = nullptr;    // the smallest sum of path costs
  std::uint8_t* second = nullptr;  // the smallest sum of candidates that are not its neighbours
};

using RowPair = std::array<SweepRow, 2>;
using WinnerPair = std::array<WinnerPointers, 2>;

// Functions that depend on the number of candidates are listed by candidates / kCandidateStep - 1.
struct CensusKernels {
  static constexpr int kSizes = kMaxCandidates / kCandidateStep;
  using Census = void (*)(const std::uint8_t* const* rows, int width_px, const PixelRow& out);
  using Penalties = void (*)(const std::uint8_t* here, const std::uint8_t* above,
                             const PenaltyTable& table, int width_px, const PenaltyRows& out);
  using Down = void (*)(const SweepRow& row);
  using Along = void (*)(const RowPair& rows, const WinnerPair& out);

  // `rows` are the 7 rows about this one, each with 4 more pixels on either side.
  Census census = nullptr;
  Penalties penalties = nullptr;
  // The costs and the three paths from above: fills cost and sum.
  std::array<Down, kSizes> down = {};
  // The paths from the left and from the right of two rows, then their winners.
  std::array<Along, kSizes> along = {};
};

const CensusKernels& portable_census_kernels();
const CensusKernels* avx2_census_kernels();  // nullptr on a machine without AVX2
const CensusKernels*
avx512_census_kernels();  // nullptr on a machine without AVX-512 BW, VL, VBMI and BITALG
const CensusKernels& fastest_census_kernels();

}  // namespace stereovox
