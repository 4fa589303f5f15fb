#include <algorithm>
#include <bit>
#include <cstdlib>

#include "stereovox/stereo/census_rows.h"

namespace stereovox {
namespace {

// A pixel outside the image has the census of the nearest one inside.
std::uint32_t census(const cv::Mat1b& image, int x, int y) {
  x = std::clamp(x, 0, image.cols - 1);
  std::uint32_t word = 0;
  int k = 0;
  for (int dy = -kCensusHalfHeight_px; dy <= 0; ++dy)
    for (int dx = -kCensusHalfWidth_px; dx <= kCensusHalfWidth_px; ++dx) {
      if (dy == 0 && dx >= 0) break;
      const bool is_set =
          nearest_pixel(image, x + dx, y + dy) >= nearest_pixel(image, x - dx, y - dy);
      word |= static_cast<std::uint32_t>(is_set) << k++;
    }
  return word;
}

int mean(int a, int b) { return (a + b + 1) / 2; }

// Clipped change of brightness along the row, smoothed across it.
int slope(const cv::Mat1b& image, int x, int y) {
  x = std::clamp(x, 0, image.cols - 1);
  const auto smooth = [&](int column) {
    return mean(nearest_pixel(image, column, y),
                mean(nearest_pixel(image, column, y - 1), nearest_pixel(image, column, y + 1)));
  };
  return std::clamp(smooth(x + 1) - smooth(x - 1), -kMaxSlope_gray, kMaxSlope_gray);
}

}  // namespace

int matching_cost_reference(const RectifiedPair& pair, int x, int y, int disparity_px) {
  const cv::Mat1b &left = pair.left.pixels, &right = pair.right.pixels;
  const int x_right = x - disparity_px;
  const int ones = std::popcount(census(left, x, y) ^ census(right, x_right, y));
  const int slopes = std::abs(slope(left, x, y) - slope(right, x_right, y));
  const int both = mean(ones, std::min(kSlopeWeight * slopes, kMaxSlopeCost));
  return mean(both, mean(both, 0));
}

}  // namespace stereovox
