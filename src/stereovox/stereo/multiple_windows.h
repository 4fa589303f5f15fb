// Winner takes all on census costs summed over squares about a pixel and about its neighbours: the
// square in the middle always counts, of the others only the better half. At the border of a thing
// those that reach across it drop out. After Hirschmueller, Innocent and Garibaldi ("Real-time
// correlation-based stereo vision with reduced border errors", IJCV 2002), on another cost.
#pragma once

#include <cstdint>
#include <vector>

#include "stereovox/stereo/census_rows.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/window_kernels.h"

namespace stereovox {

struct MultipleWindows {
  int half_px = 3;  // a window has 2 half_px + 1 rows and columns; up to kMaxWindowHalf_px
  NeighbourWindows neighbours = NeighbourWindows::eight;

  int area() const;  // pixels of all windows that count, each as often as it counts
};

class MultipleWindowSweep {
 public:
  // Starts with `first_row`. Refers to `pair`. Beyond the image costs are those at its edge.
  MultipleWindowSweep(const CensusPair& pair, const MultipleWindows& windows, int min_disparity_px,
                      int candidates, int first_row, const WindowKernels& kernels);

  void next_row(WinnerRow& found);  // `found` has the images' width

 private:
  void fill_columns();
  void sum_until(int end_row);
  std::uint8_t* costs_at(int row);
  std::uint16_t* boxes_at(int row);

  const MultipleWindows windows_;
  const WindowKernels& kernels_;
  const std::size_t size_index_;  // of the kernels for this number of candidates
  const int width_px_, height_px_, candidates_;
  CensusRows pixels_;
  int y_, summed_, compared_;           // the next row; the first ones without sums, without costs
  std::vector<std::uint16_t> columns_;  // sums over the rows of a window
  std::vector<std::vector<std::uint16_t>> boxes_;  // sums over windows
  std::vector<std::vector<std::uint8_t>> costs_;
};

// The same winners of rows [first_row, end_row), plainly: the oracle of the tests.
std::vector<WinnerRow> multiple_windows_reference(const RectifiedPair& pair,
                                                  const MultipleWindows& windows,
                                                  int min_disparity_px, int candidates,
                                                  int first_row, int end_row);

}  // namespace stereovox
