#include "stereovox/stereo/opencv_matching.h"

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "stereovox/stereo/texture_sigma.h"

namespace stereovox {
namespace {

constexpr float kSixteenth = 1.0F / static_cast<float>(cv::StereoMatcher::DISP_SCALE);

cv::Mat1b extended_left(const GrayImage& image, int columns) {
  cv::Mat1b out;
  cv::copyMakeBorder(image.pixels, out, 0, 0, columns, 0, cv::BORDER_REPLICATE);
  return out;
}

bool is_recorded(const cv::Mat1b& valid, int v, int u) { return valid.empty() || valid(v, u) != 0; }

}  // namespace

DisparityImage match_with_opencv(const RectifiedPair& pair, cv::StereoMatcher& matcher,
                                 const DisparitySearch& search) {
  const int max_disparity_px = search.max_disparity_px();
  cv::Mat1s sixteenths;
  matcher.compute(extended_left(pair.left, max_disparity_px),
                  extended_left(pair.right, max_disparity_px), sixteenths);

  const cv::Mat1f sigma_px = texture_sigma_px(pair.left, search.sigma_px, search.sigma_noise_gray);
  const cv::Size size = pair.left.pixels.size();
  DisparityImage out{cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F)};
  for (int v = 0; v < size.height; ++v) {
    const short* const found = sixteenths.ptr<short>(v) + max_disparity_px;
    for (int u = 0; u < size.width; ++u) {
      const float disparity_px = static_cast<float>(found[u]) * kSixteenth;
      const int u_right = u - static_cast<int>(std::lround(disparity_px));
      if (found[u] <= 0 || u_right < 0) continue;
      if (!is_recorded(pair.valid_left, v, u) || !is_recorded(pair.valid_right, v, u_right))
        continue;
      out.disparity_px(v, u) = disparity_px;
      out.sigma_px(v, u) = sigma_px(v, u);
    }
  }
  return out;
}

}  // namespace stereovox
