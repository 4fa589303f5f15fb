// The inner loops of the census matchers, compiled once for AVX2 and once for any machine; both
// give the same bytes. Plain pointers throughout, so that the code for AVX2 shares nothing that a
// linker could mistake for code for every machine.
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
// The change of brightness along the row counts up to this, and weighs this much, against census
// bits; their mean is the cost. Census alone confuses fine structures.
inline constexpr int kMaxSlope_gray = 40, kSlopeWeight = 2, kMaxSlopeCost = 31;
// Rows of bytes may be read and written this far beyond their end.
inline constexpr int kRowSlack = 32;
// Bytes between the candidates of two pixels in a row of path costs: a wall that no step crosses.
inline constexpr int kPathWall = 32;

// What pixels of one image row are compared by, byte by byte. The centre-symmetric census: bit b of
// plane p says whether pixel k = 8 p + b of the upper half of a 9 x 7 window is at least as bright
// as its mirror image in the lower half. And the clipped slope of the brightness, plus 128.
struct PixelRow {
  std::array<std::uint8_t*, kPlanes> planes = {};
};

// One row of images that semi-global aggregation has reached, and what it keeps from row to row.
struct SweepRow {
  int width_px = 0;
  std::uint8_t small_penalty = 0;
  // Of a disparity jump between each pixel and the one before it, and the ones above, above to the
  // left, above to the right.
  const std::uint8_t* penalty_beside = nullptr;
  std::array<const std::uint8_t*, 3> penalty_above = {};
  // Path costs above their minimum, width x (candidates + kPathWall), for the three paths from
  // above. Row y keeps pixel x in slot (first_slot + x) mod width: chosen so that the pixel that a
  // path comes from lies in the same slot, and is overwritten where it is read.
  std::array<std::uint8_t*, 3> paths_above = {};
  std::array<int, 3> first_slot = {};
  // Differences, width x candidates, of the row above, this one and the one below.
  std::array<const std::uint8_t*, 3> differences = {};
  std::uint8_t* cost = nullptr;  // width x candidates: the mean of these rows
  std::uint8_t* sum = nullptr;   // width x candidates: of path costs, at most 255
};

// What the best candidate of each pixel of a row is, the first one of equals.
struct WinnerPointers {
  std::uint8_t* candidate = nullptr;
  std::uint8_t* cost = nullptr;    // its sum of path costs
  std::uint8_t* second = nullptr;  // the smallest sum of candidates that are not its neighbours
};

// Functions that depend on the number of candidates are listed by candidates / kCandidateStep - 1.
struct CensusKernels {
  static constexpr int kSizes = kMaxCandidates / kCandidateStep;
  using Census = void (*)(const std::uint8_t* const* rows, int width_px, const PixelRow& out);
  using Differences = void (*)(int width_px, const PixelRow& left, const PixelRow& right,
                               std::uint8_t* out);
  using Forward = void (*)(const SweepRow& row);
  using Backward = void (*)(const SweepRow& row, const WinnerPointers& out);

  // `rows` are the 7 rows about this one, each with 4 more pixels on either side.
  Census census = nullptr;
  // Differences of pixels, smoothed along the row; candidate i of left pixel x is right pixel x +
  // i.
  std::array<Differences, kSizes> differences = {};
  // The costs and the four paths from the left and from above: fills cost and sum.
  std::array<Forward, kSizes> forward = {};
  // The path from the right, then the winners.
  std::array<Backward, kSizes> backward = {};
};

const CensusKernels& portable_census_kernels();
const CensusKernels* avx2_census_kernels();  // nullptr on a machine without AVX2
const CensusKernels& fastest_census_kernels();

}  // namespace stereovox
