#include "stereovox/stereo/multiple_windows.h"

#include <algorithm>

namespace stereovox {

int MultipleWindows::area() const {
  const int side_px = 2 * half_px + 1;
  return side_px * side_px * (1 + number_of(neighbours) / 2);
}

MultipleWindowSweep::MultipleWindowSweep(const CensusPair& pair, const MultipleWindows& windows,
                                         int min_disparity_px, int candidates, int first_row,
                                         const WindowKernels& kernels)
    : windows_(windows),
      kernels_(kernels),
      size_index_(candidates / kCandidateStep - 1),
      width_px_(pair.width_px),
      height_px_(pair.height_px),
      candidates_(candidates),
      pixels_(pair, min_disparity_px, min_disparity_px + candidates - 1, kernels.census),
      y_(first_row),
      summed_(std::max(0, first_row - windows.half_px)),
      compared_(std::max(0, summed_ - windows.half_px - 1)),
      columns_(static_cast<std::size_t>(width_px_) * candidates),
      boxes_(2 * windows.half_px + 1, columns_),
      costs_(2 * windows.half_px + 2, std::vector<std::uint8_t>(columns_.size() + kRowSlack)) {
  fill_columns();
}

void MultipleWindowSweep::next_row(WinnerRow& found) {
  const int above = std::max(y_ - windows_.half_px, 0);
  const int below = std::min(y_ + windows_.half_px, height_px_ - 1);
  sum_until(below + 1);
  const SupportedRow row{.width_px = width_px_,
                         .half_px = windows_.half_px,
                         .boxes = {boxes_at(above), boxes_at(y_), boxes_at(below)},
                         .area = windows_.area()};
  const auto neighbours = static_cast<std::size_t>(windows_.neighbours);
  kernels_.choose_supported[neighbours][size_index_](row, found.pointers());
  choose_locally(costs_at(y_), candidates_, found);
  ++y_;
}

// As they are above the first row that is summed.
void MultipleWindowSweep::fill_columns() {
  for (int k = -windows_.half_px - 1; k < windows_.half_px; ++k) {
    const std::uint8_t* const costs = costs_at(summed_ + k);
    for (std::size_t i = 0; i < columns_.size(); ++i)
      columns_[i] = static_cast<std::uint16_t>(columns_[i] + costs[i]);
  }
}

void MultipleWindowSweep::sum_until(int end_row) {
  for (; summed_ < end_row; ++summed_)
    kernels_.sum_boxes[size_index_]({.width_px = width_px_,
                                     .half_px = windows_.half_px,
                                     .entering = costs_at(summed_ + windows_.half_px),
                                     .leaving = costs_at(summed_ - windows_.half_px - 1),
                                     .column = columns_.data(),
                                     .box = boxes_at(summed_)});
}

// Of the nearest row inside the image, compared now if it was not before.
std::uint8_t* MultipleWindowSweep::costs_at(int row) {
  const int inside = std::clamp(row, 0, height_px_ - 1);
  for (; compared_ <= inside; ++compared_) {
    CostRow costs{.width_px = width_px_,
                  .left = {},
                  .right = {},
                  .cost = costs_[compared_ % costs_.size()].data()};
    pixels_.read(compared_, costs.left, costs.right);
    kernels_.costs[size_index_](costs);
  }
  return costs_[inside % costs_.size()].data();
}

std::uint16_t* MultipleWindowSweep::boxes_at(int row) { return boxes_[row % boxes_.size()].data(); }

}  // namespace stereovox
