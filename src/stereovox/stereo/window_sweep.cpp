#include "stereovox/stereo/window_sweep.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

// An arm that reaches 1 px where there is a pixel, and no farther than the image.
std::uint8_t bounded(std::uint8_t arm, int to_border_px) {
  return static_cast<std::uint8_t>(std::min(std::max<int>(arm, 1), to_border_px));
}

cv::Mat1b padded_for_arms(const cv::Mat1b& image) {
  cv::Mat1b calm, out;
  cv::medianBlur(image, calm, 3);
  cv::copyMakeBorder(calm, out, kMaxArm_px, kMaxArm_px, kMaxArm_px, kMaxArm_px + kRowSlack,
                     cv::BORDER_REPLICATE);
  return out;
}

// The kernels write whole vectors, so rows have slack.
cv::Mat1b image_of_arms(cv::Size size) {
  return cv::Mat1b(size.height, size.width + kRowSlack).colRange(0, size.width);
}

void bound_arms(Arms& arms, int y) {
  const int width = arms.left.cols, height = arms.left.rows;
  for (int x = 0; x < width; ++x) {
    arms.left(y, x) = bounded(arms.left(y, x), x);
    arms.right(y, x) = bounded(arms.right(y, x), width - 1 - x);
    arms.up(y, x) = bounded(arms.up(y, x), y);
    arms.down(y, x) = bounded(arms.down(y, x), height - 1 - y);
  }
}

}  // namespace

Arms arms_of(const cv::Mat1b& image, const ArmParams& params, const WindowKernels& kernels,
             int threads) {
  const cv::Size size = image.size();
  const cv::Mat1b padded = padded_for_arms(image);
  const auto row_step = static_cast<std::ptrdiff_t>(padded.step);
  Arms arms{image_of_arms(size), image_of_arms(size), image_of_arms(size), image_of_arms(size),
            params.max_arm_px};
  parallel_for(0, size.height, threads, [&](int y) {
    ArmRow row{.from = padded[y + kMaxArm_px] + kMaxArm_px,
               .width_px = size.width,
               .max_arm_px = params.max_arm_px,
               .contrast_gray = static_cast<std::uint8_t>(params.contrast_gray)};
    const auto grow = [&](std::ptrdiff_t step, cv::Mat1b& out) {
      row.step = step;
      kernels.arms(row, out[y]);
    };
    grow(-1, arms.left);
    grow(1, arms.right);
    grow(-row_step, arms.up);
    grow(row_step, arms.down);
    bound_arms(arms, y);
  });
  return arms;
}

WindowSweep::WindowSweep(const CensusPair& pair, const Arms& arms, int min_disparity_px,
                         int candidates, int first_row, const WindowKernels& kernels)
    : arms_(arms),
      kernels_(kernels),
      size_index_(candidates / kCandidateStep - 1),
      width_px_(pair.width_px),
      height_px_(pair.height_px),
      candidates_(candidates),
      pixels_(pair, min_disparity_px, min_disparity_px + candidates - 1, kernels.census),
      y_(first_row),
      gathered_(std::max(0, first_row - arms.max_arm_px)),
      along_(static_cast<std::size_t>(width_px_ + 1) * candidates),
      area_(width_px_),
      sums_(2 * arms.max_arm_px + 2) {
  for (auto& row : sums_) row.resize(static_cast<std::size_t>(width_px_) * candidates);
  areas_.resize(sums_.size(), area_);
  costs_.resize(arms.max_arm_px + 1);
  for (auto& row : costs_) row.resize(static_cast<std::size_t>(width_px_) * candidates + kRowSlack);
}

void WindowSweep::next_row(WinnerRow& found) {
  gather_until(std::min(y_ + arms_.max_arm_px + 1, height_px_));
  find_areas();
  ChoiceRow row{.width_px = width_px_,
                .arm_up = arms_.up[y_],
                .arm_down = arms_.down[y_],
                .area = area_.data()};
  for (int k = 0; k <= arms_.max_arm_px; ++k) {
    row.before[k] = sums_above(std::max(y_ - k, 0));
    row.after[k] = sums_above(std::min(y_ + k + 1, height_px_));
  }
  kernels_.choose[size_index_](row, found.pointers());
  choose_locally(costs_of(y_), candidates_, found);
  ++y_;
}

void WindowSweep::gather_until(int end_row) {
  while (gathered_ < end_row) gather_row();
}

void WindowSweep::gather_row() {
  const int y = gathered_++;
  GatherRow row{.width_px = width_px_,
                .left = {},
                .right = {},
                .arm_left = arms_.left[y],
                .arm_right = arms_.right[y],
                .cost = costs_of(y),
                .along = along_.data(),
                .above = sums_above(y),
                .below = sums_above(y + 1)};
  pixels_.read(y, row.left, row.right);
  kernels_.gather[size_index_](row);
  const std::uint16_t* const above = areas_above(y);
  std::uint16_t* const below = areas_above(y + 1);
  for (int x = 0; x < width_px_; ++x)
    below[x] = static_cast<std::uint16_t>(above[x] + row.arm_left[x] + 1 + row.arm_right[x]);
}

std::uint8_t* WindowSweep::costs_of(int row) { return costs_[row % costs_.size()].data(); }
std::uint16_t* WindowSweep::sums_above(int row) { return sums_[row % sums_.size()].data(); }
std::uint16_t* WindowSweep::areas_above(int row) { return areas_[row % areas_.size()].data(); }

void WindowSweep::find_areas() {
  for (int x = 0; x < width_px_; ++x)
    area_[x] = static_cast<std::uint16_t>(areas_above(y_ + arms_.down(y_, x) + 1)[x] -
                                          areas_above(y_ - arms_.up(y_, x))[x]);
}

}  // namespace stereovox
