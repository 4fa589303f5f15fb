#include "stereovox/stereo/census_sweep.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace stereovox {
namespace {

constexpr int kPenaltyRows = 4;  // from beside, above, above left, above right

constexpr int kMaxCost = std::max(kCensusBits, kMaxSlopeCost);
static_assert(kLocalWidth_px * kMaxCost < kNoLocalCost, "local sums must fit a byte");

}  // namespace

WinnerRow::WinnerRow(int width_px)
    : candidate(width_px),
      cost(width_px),
      second(width_px),
      local_before(width_px),
      local(width_px),
      local_after(width_px) {}

WinnerPointers WinnerRow::pointers() {
  return {candidate.data(),    cost.data(),  second.data(),
          local_before.data(), local.data(), local_after.data()};
}

CensusSweep::CensusSweep(const CensusPair& pair, const SweepParams& params, int first_row,
                         const CensusKernels& kernels)
    : pair_(pair),
      params_(params),
      kernels_(kernels),
      size_index_(params.candidates / kCandidateStep - 1),
      pixels_(pair, params.min_disparity_px, params.max_disparity_px(), kernels.census),
      y_(first_row) {
  const int width = pair.width_px, candidates = params.candidates;
  cost_ = row_of_bytes(width * candidates);
  sum_ = row_of_bytes(width * candidates);
  penalties_ = row_of_bytes(kPenaltyRows * (width + 1));
  row_.width_px = width;
  row_.small_penalty = static_cast<std::uint8_t>(params.small_penalty);
  row_.cost = cost_.data;
  row_.sum = sum_.data;
  row_.penalty_beside = penalties_.data;
  for (int k = 0; k < 3; ++k) {
    row_.penalty_above[k] = penalties_.data + (k + 1) * (width + 1);
    paths_above_[k] = row_of_bytes(width * (candidates + kPathWall) + kPathWall);
    paths_above_[k].setTo(255);
    row_.paths_above[k] = paths_above_[k].data;
    for (int x = 0; x < width; ++x)
      std::memset(row_.paths_above[k] + x * (candidates + kPathWall) + kPathWall, 0, candidates);
  }
}

void CensusSweep::skip_row() {
  enter_row();
  kernels_.down[size_index_](row_);
  ++y_;
}

void CensusSweep::next_row(WinnerRow& found) {
  enter_row();
  kernels_.down[size_index_](row_);
  kernels_.along[size_index_](row_, found.pointers());
  ++y_;
}

void CensusSweep::enter_row() {
  pixels_.read(y_, row_.left, row_.right);
  read_penalties();
  const int width = row_.width_px, turn = y_ % width;
  row_.first_slot = {0, (width - turn) % width, turn};
  clear_entries();
}

void CensusSweep::read_penalties() {
  const std::uint8_t* const here = image_row(pair_.left, y_);
  const std::uint8_t* const above = image_row(pair_.left, y_ - 1);
  const auto fill = [&](int row, const std::uint8_t* from) {
    std::uint8_t* const out = penalties_.data + row * (row_.width_px + 1);
    for (int x = 0; x < row_.width_px; ++x)
      out[x] = params_.large_penalty[std::abs(here[x] - from[x])];
  };
  fill(0, here - 1);
  fill(1, above);
  fill(2, above - 1);
  fill(3, above + 1);
}

// Nothing lies before the first pixel of the path from above left, or of that from above right.
void CensusSweep::clear_entries() {
  const int width = row_.width_px, stride = params_.candidates + kPathWall;
  const auto clear = [&](int k, int slot) {
    std::memset(row_.paths_above[k] + slot * stride + kPathWall, 0, params_.candidates);
  };
  clear(1, row_.first_slot[1]);
  clear(2, (row_.first_slot[2] + width - 1) % width);
}

}  // namespace stereovox
