#include "stereovox/stereo/block_matching.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/stereo/opencv_matching.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const BlockMatchingParams& p) {
  const int range_px = round_up_to_16(p.disparity_range_px);
  const int window_px = p.correlation_window_size_px | 1;
  if (window_px >= std::min(pair.left.width(), pair.left.height()))
    throw Error(fmt::format("images of {} x {} are too small for a correlation window of {} pixels",
                            pair.left.width(), pair.left.height(), window_px));
  const auto matcher = cv::StereoBM::create(range_px, window_px);
  matcher->setMinDisparity(p.min_disparity_px);
  matcher->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  matcher->setPreFilterCap(p.prefilter_cap);
  matcher->setTextureThreshold(p.texture_threshold);
  matcher->setUniquenessRatio(p.uniqueness_ratio_percent);
  matcher->setDisp12MaxDiff(p.left_right_tolerance_px);
  matcher->setSpeckleWindowSize(p.speckle_size_px);
  matcher->setSpeckleRange(p.speckle_range_px);
  return match_with_opencv(pair, *matcher, p.min_disparity_px + range_px, p.sigma_px);
}

}  // namespace stereovox
