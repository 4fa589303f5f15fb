// Semi-global matching on a census cost, row by row from top to bottom: five paths (from the left,
// the three from above, from the right) are known when a row is left, so only rows are kept in
// memory, never a volume. After Hirschmueller (PAMI 2008); the single sweep is the one of OpenCV's
// MODE_SGBM, the cost the one of libSGM (centre-symmetric census, 9 x 7).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "stereovox/core/frame.h"
#include "stereovox/stereo/census_kernels.h"
#include "stereovox/stereo/census_rows.h"
#include "stereovox/stereo/winner_row.h"

namespace stereovox {

struct SweepParams {
  int min_disparity_px = 0;
  int candidates = 64;  // a multiple of kCandidateStep, up to kMaxCandidates
  int small_penalty = 0;
  int nearer_penalty = 0;  // of the paths from above, to a disparity one larger
  PenaltyTable large_penalty = {};

  int max_disparity_px() const { return min_disparity_px + candidates - 1; }
};

class CensusSweep {
 public:
  // Starts with `first_row`, as if nothing were above it. Refers to `pair`.
  CensusSweep(const CensusPair& pair, const SweepParams& params, int first_row,
              const CensusKernels& kernels);

  void skip_row();  // the paths pass, nobody wins
  // Of this row and the one below, both as wide as the images. Below the last row there is none:
  // what is written of it means nothing.
  void next_rows(std::array<WinnerRow, 2>& found);
  // Width x candidates: of the first of these rows.
  const std::uint8_t* costs() const { return rows_[0].cost; }

 private:
  void give_memory(std::size_t row);
  void pass_down(SweepRow& row);
  void clear_entries(const SweepRow& row) const;

  const CensusPair& pair_;
  const SweepParams params_;
  const CensusKernels& kernels_;
  const std::size_t size_index_;  // of the kernels for this number of candidates
  CensusRows pixels_;
  int y_;
  // Matrices only because they are aligned; each is one row.
  std::array<cv::Mat1b, 2> cost_, sum_, penalties_;
  std::array<cv::Mat1b, 3> paths_above_;
  RowPair rows_;
};

// The same winners of rows [first_row, end_row), plainly: every cost and path in a volume, one
// number at a time. The oracle of the tests.
std::vector<WinnerRow> sweep_reference(const RectifiedPair& pair, const SweepParams& params,
                                       int first_row, int end_row);

// choose_locally and doubt_repetitions, plainly. CostAt(x, candidate) is a cost of that row.
using CostAt = std::function<int(int, int)>;
void choose_locally_reference(const CostAt& cost, int candidates, WinnerRow& row);
void doubt_repetitions_reference(const CostAt& cost, int candidates, WinnerRow& row);

}  // namespace stereovox
