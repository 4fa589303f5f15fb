#include "stereovox/stereo/census_sweep.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace stereovox {
namespace {

constexpr int kPenaltyRows = 4;

}  // namespace

CensusSweep::CensusSweep(const CensusPair& pair, const SweepParams& params, int first_row,
                         const CensusKernels& kernels)
    : pair_(pair),
      params_(params),
      kernels_(kernels),
      size_index_(params.candidates / kCandidateStep - 1),
      pixels_(pair, params.min_disparity_px, params.max_disparity_px(), kernels.census),
      y_(first_row) {
  for (std::size_t i = 0; i < rows_.size(); ++i) give_memory(i);
  for (std::size_t k = 0; k < paths_above_.size(); ++k) {
    paths_above_[k] = row_of_bytes(pair.width_px * params.candidates);
    for (SweepRow& row : rows_) row.paths_above[k] = paths_above_[k].data;
  }
}

void CensusSweep::give_memory(std::size_t i) {
  const int width = pair_.width_px, penalty_stride = width + 1 + kRowSlack;
  cost_[i] = row_of_bytes(width * params_.candidates);
  sum_[i] = row_of_bytes(width * params_.candidates);
  penalties_[i] = row_of_bytes(kPenaltyRows * penalty_stride);
  SweepRow& row = rows_[i];
  row.width_px = width;
  row.small_penalty = static_cast<std::uint8_t>(params_.small_penalty);
  row.nearer_penalty = static_cast<std::uint8_t>(params_.nearer_penalty);
  row.cost = cost_[i].data;
  row.sum = sum_[i].data;
  row.penalty.beside = penalties_[i].data;
  for (int k = 0; k < 3; ++k) row.penalty.above[k] = penalties_[i].data + (k + 1) * penalty_stride;
}

void CensusSweep::skip_row() { pass_down(rows_[0]); }

void CensusSweep::next_rows(std::array<WinnerRow, 2>& found) {
  for (SweepRow& row : rows_)
    if (y_ < pair_.height_px) pass_down(row);
  kernels_.along[size_index_](rows_, {found[0].pointers(), found[1].pointers()});
  for (std::size_t i = 0; i < found.size(); ++i) {
    choose_locally(rows_[i].cost, params_.candidates, found[i]);
    doubt_repetitions(rows_[i].cost, params_.candidates, found[i]);
  }
}

void CensusSweep::pass_down(SweepRow& row) {
  pixels_.read(y_, row.left, row.right);
  kernels_.penalties(image_row(pair_.left, y_), image_row(pair_.left, y_ - 1),
                     params_.large_penalty, row.width_px, row.penalty);
  const int turn = y_ % row.width_px;
  row.first_slot = {0, (row.width_px - turn) % row.width_px, turn};
  clear_entries(row);
  kernels_.down[size_index_](row);
  ++y_;
}

// Nothing lies before the first pixel of the path from above left, or of that from above right.
void CensusSweep::clear_entries(const SweepRow& row) const {
  const auto clear = [&](int k, int slot) {
    std::memset(row.paths_above[k] + slot * params_.candidates, 0, params_.candidates);
  };
  clear(1, row.first_slot[1]);
  clear(2, (row.first_slot[2] + row.width_px - 1) % row.width_px);
}

}  // namespace stereovox
