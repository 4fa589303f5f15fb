#include "stereovox/stereo/disparity_picture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stereovox {
namespace {

struct Span {
  float low, high;
};

Span usual_span(const cv::Mat1f& disparity_px) {
  std::vector<float> known;
  for (const float d : disparity_px)
    if (d > 0.0F) known.push_back(d);
  if (known.empty()) return {0.0F, 1.0F};
  std::ranges::sort(known);
  const std::size_t margin = known.size() / 100;
  return {known[margin], std::max(known[known.size() - 1 - margin], known[margin] + 1.0F)};
}

}  // namespace

cv::Mat3b draw_disparity(const DisparityImage& disparity) {
  const Span span = usual_span(disparity.disparity_px);
  const double scale = 255.0 / (span.high - span.low);
  cv::Mat1b levels;
  disparity.disparity_px.convertTo(levels, CV_8U, scale, -span.low * scale);
  cv::Mat3b picture;
  cv::applyColorMap(levels, picture, cv::COLORMAP_TURBO);
  picture.setTo(cv::Vec3b(0, 0, 0), disparity.disparity_px == 0.0F);
  return picture;
}

}  // namespace stereovox
