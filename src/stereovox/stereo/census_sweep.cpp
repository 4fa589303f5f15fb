#include "stereovox/stereo/census_sweep.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

constexpr int kWindowHeight_px = 2 * kCensusHalfHeight_px + 1;
constexpr int kPenaltyRows = 4;  // from beside, above, above left, above right

// The pixel at (0, y) of the image that was padded.
const std::uint8_t* image_row(const cv::Mat1b& padded, int y) {
  return padded.ptr<std::uint8_t>(y + kCensusHalfHeight_px) + kCensusHalfWidth_px;
}

cv::Mat1b padded(const cv::Mat1b& image) {
  cv::Mat1b out;
  cv::copyMakeBorder(image, out, kCensusHalfHeight_px, kCensusHalfHeight_px, kCensusHalfWidth_px,
                     kCensusHalfWidth_px + kRowSlack, cv::BORDER_REPLICATE);
  return out;
}

cv::Mat1b bytes(int count) { return cv::Mat1b(1, count + kRowSlack, std::uint8_t{0}); }

void census_of_row(const CensusKernels& kernels, const cv::Mat1b& image, int y, int width_px,
                   const PixelRow& out) {
  std::array<const std::uint8_t*, kWindowHeight_px> rows = {};
  for (int i = 0; i < kWindowHeight_px; ++i)
    rows[i] = image_row(image, y + i - kCensusHalfHeight_px);
  kernels.census(rows.data(), width_px, out);
}

// Splits `planes`, one row of memory, into the planes of a row with `before` and `after` pixels
// beyond its ends.
PixelRow plane_pointers(cv::Mat1b& planes, int before, int width_px, int after) {
  PixelRow row;
  for (int p = 0; p < kPlanes; ++p)
    row.planes[p] = planes.data + p * (before + width_px + after + kRowSlack) + before;
  return row;
}

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

CensusPair pad_for_census(const RectifiedPair& pair) {
  return {padded(pair.left.pixels), padded(pair.right.pixels), pair.left.width(),
          pair.left.height()};
}

CensusSweep::CensusSweep(const CensusPair& pair, const SweepParams& params, int first_row,
                         const CensusKernels& kernels)
    : pair_(pair),
      params_(params),
      kernels_(kernels),
      size_index_(params.candidates / kCandidateStep - 1),
      y_(first_row) {
  const int width = pair.width_px, candidates = params.candidates;
  const int before = std::max(0, params.max_disparity_px());
  const int after = std::max(0, -params.min_disparity_px);
  left_census_ = bytes(kPlanes * (width + kRowSlack));
  right_census_ = bytes(kPlanes * (before + width + after + kRowSlack));
  cost_ = bytes(width * candidates);
  sum_ = bytes(width * candidates);
  penalties_ = bytes(kPenaltyRows * (width + 1));
  row_.width_px = width;
  row_.small_penalty = static_cast<std::uint8_t>(params.small_penalty);
  row_.cost = cost_.data;
  row_.sum = sum_.data;
  row_.penalty_beside = penalties_.data;
  for (int k = 0; k < 3; ++k) {
    row_.penalty_above[k] = penalties_.data + (k + 1) * (width + 1);
    paths_above_[k] = bytes(width * (candidates + kPathWall) + kPathWall);
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
  read_pixels();
  read_penalties();
  const int width = row_.width_px, turn = y_ % width;
  row_.first_slot = {0, (width - turn) % width, turn};
  clear_entries();
}

void CensusSweep::read_pixels() {
  const int width = row_.width_px;
  const int before = std::max(0, params_.max_disparity_px());
  const int after = std::max(0, -params_.min_disparity_px);
  row_.left = plane_pointers(left_census_, 0, width, 0);
  row_.right = plane_pointers(right_census_, before, width, after);
  census_of_row(kernels_, pair_.left, y_, width, row_.left);
  census_of_row(kernels_, pair_.right, y_, width, row_.right);
  for (std::uint8_t*& plane : row_.right.planes) {
    std::memset(plane - before, plane[0], before);
    std::memset(plane + width, plane[width - 1], after + kRowSlack);
    plane -= params_.max_disparity_px();
  }
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
