// The best candidates of a row of pixels, and what a matcher knows of them.
#pragma once

#include <cstdint>
#include <vector>

#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

struct WinnerRow {
  std::vector<std::uint8_t> candidate, cost, second;  // see WinnerPointers
  // Local costs of the winner and its neighbours; kNoLocalCost where there is no such candidate.
  std::vector<std::uint8_t> local_before, local, local_after;

  explicit WinnerRow(int width_px);
  WinnerPointers pointers();
  bool operator==(const WinnerRow&) const = default;
};

// Paths from above drag disparities along where a surface leans towards the camera, as floors do,
// and windows are right for their middle only. So each winner is chosen anew among the one found
// and its two neighbours, by the local cost alone: that of the pixels of the row that lie up to
// kLocalWidth_px / 2 beside it, where the ends of the row repeat. Equals leave the winner where it
// is, or take the one before. `cost` holds width x candidates costs, and kRowSlack bytes more can
// be read.
void choose_locally(const std::uint8_t* cost, int candidates, WinnerRow& row);

// Where a winner costs nothing, and a candidate farther than kChoiceReach from it costs nothing
// either, images without noise repeat or show nothing; paths then decide by what they met at the
// border. There the second best becomes as good as the best. After choose_locally.
void doubt_repetitions(const std::uint8_t* cost, int candidates, WinnerRow& row);

}  // namespace stereovox
