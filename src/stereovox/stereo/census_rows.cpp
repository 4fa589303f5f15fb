#include "stereovox/stereo/census_rows.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

constexpr int kWindowHeight_px = 2 * kCensusHalfHeight_px + 1;

cv::Mat1b padded(const cv::Mat1b& image) {
  cv::Mat1b out;
  cv::copyMakeBorder(image, out, kCensusHalfHeight_px, kCensusHalfHeight_px, kCensusHalfWidth_px,
                     kCensusHalfWidth_px + kRowSlack, cv::BORDER_REPLICATE);
  return out;
}

void census_of_row(CensusKernels::Census census, const cv::Mat1b& image, int y, int width_px,
                   const PixelRow& out) {
  std::array<const std::uint8_t*, kWindowHeight_px> rows = {};
  for (int i = 0; i < kWindowHeight_px; ++i)
    rows[i] = image_row(image, y + i - kCensusHalfHeight_px);
  census(rows.data(), width_px, out);
}

// Splits `planes`, one row of memory, into the planes of a row with `before` and `after` pixels
// beyond its ends.
PixelRow plane_pointers(cv::Mat1b& planes, int before, int width_px, int after) {
  PixelRow row;
  for (int p = 0; p < kPlanes; ++p)
    row.planes[p] = planes.data + p * (before + width_px + after + kRowSlack) + before;
  return row;
}

}  // namespace

CensusPair pad_for_census(const RectifiedPair& pair) {
  return {padded(pair.left.pixels), padded(pair.right.pixels), pair.left.width(),
          pair.left.height()};
}

RectifiedPair equally_exposed(const RectifiedPair& pair) {
  constexpr double kAlike = 1.2;  // what the two see differs by less
  const double left = cv::mean(pair.left.pixels)[0], right = cv::mean(pair.right.pixels)[0];
  if (left <= kAlike * right && right <= kAlike * left) return pair;
  RectifiedPair equal = pair;
  cv::Mat1b& darker = left < right ? equal.left.pixels : equal.right.pixels;
  cv::Mat1b brightened;  // `darker` shares its memory with the image of the caller
  darker.convertTo(brightened, CV_8U, std::max(left, right) / std::max(std::min(left, right), 1.0));
  darker = brightened;
  return equal;
}

const std::uint8_t* image_row(const cv::Mat1b& padded, int y) {
  return padded.ptr<std::uint8_t>(y + kCensusHalfHeight_px) + kCensusHalfWidth_px;
}

cv::Mat1b row_of_bytes(int count) {
  cv::Mat1b row(1, count + kRowSlack);
  std::fill_n(row.data, row.cols, std::uint8_t{0});
  return row;
}

CensusRows::CensusRows(const CensusPair& pair, int min_disparity_px, int max_disparity_px,
                       CensusKernels::Census census)
    : pair_(pair),
      max_disparity_px_(max_disparity_px),
      before_(std::max(0, max_disparity_px)),
      after_(std::max(0, -min_disparity_px)),
      census_(census),
      left_census_(row_of_bytes(kPlanes * (pair.width_px + kRowSlack))),
      right_census_(row_of_bytes(kPlanes * (before_ + pair.width_px + after_ + kRowSlack))) {}

void CensusRows::read(int y, PixelRow& left, PixelRow& right) {
  const int width = pair_.width_px;
  left = plane_pointers(left_census_, 0, width, 0);
  right = plane_pointers(right_census_, before_, width, after_);
  census_of_row(census_, pair_.left, y, width, left);
  census_of_row(census_, pair_.right, y, width, right);
  for (std::uint8_t*& plane : right.planes) {
    std::memset(plane - before_, plane[0], before_);
    std::memset(plane + width, plane[width - 1], after_ + kRowSlack);
    plane -= max_disparity_px_;
  }
}

}  // namespace stereovox
