// The rows of a pair that census matchers compare: the census of both images, row by row.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "stereovox/core/frame.h"
#include "stereovox/stereo/census_kernels.h"

namespace stereovox {

// Both images with the borders that a census window needs, repeated from the edge.
struct CensusPair {
  cv::Mat1b left, right;  // padded
  int width_px = 0, height_px = 0;
};
CensusPair pad_for_census(const RectifiedPair& pair);

// The pair with the darker image as bright as the other one in the mean, where one camera exposes
// clearly longer: the census does not mind, but slopes are compared in grey values.
RectifiedPair equally_exposed(const RectifiedPair& pair);

// The pixel at (0, y) of an image of a CensusPair.
const std::uint8_t* image_row(const cv::Mat1b& padded, int y);

// One aligned row of memory, all zero, with kRowSlack more at its end.
cv::Mat1b row_of_bytes(int count);

// Keeps the census of one row of each image. Candidate i of left pixel x is pixel x + i of `right`;
// beyond the image it is the nearest pixel inside.
class CensusRows {
 public:
  // Refers to `pair`.
  CensusRows(const CensusPair& pair, int min_disparity_px, int max_disparity_px,
             CensusKernels::Census census);
  void read(int y, PixelRow& left, PixelRow& right);

 private:
  const CensusPair& pair_;
  const int max_disparity_px_;
  const int before_, after_;  // right pixels beyond the image that candidates may reach
  const CensusKernels::Census census_;
  cv::Mat1b left_census_, right_census_;  // each is one row
};

// The cost of joining left pixel (x, y) with right pixel (x - disparity_px, y), plainly: the oracle
// of the tests.
int matching_cost_reference(const RectifiedPair& pair, int x, int y, int disparity_px);

// The pixel nearest to (x, y) that lies in the image.
inline int nearest_pixel(const cv::Mat1b& image, int x, int y) {
  return image(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

}  // namespace stereovox
