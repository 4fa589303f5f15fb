#include "stereovox/stereo/block_matching.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/stereo/opencv_matching.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const BlockMatchingParams& p, int /*threads*/) {
  const DisparitySearch& search = p.search;
  const int window_px = p.correlation_window_size_px | 1;
  if (window_px >= std::min(pair.left.width(), pair.left.height()))
    throw Error(fmt::format("images of {} x {} are too small for a correlation window of {} pixels",
                            pair.left.width(), pair.left.height(), window_px));
  const auto matcher = cv::StereoBM::create(search.range_px(), window_px);
  matcher->setMinDisparity(search.min_disparity_px);
  matcher->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  matcher->setPreFilterCap(search.prefilter_cap);
  matcher->setTextureThreshold(p.texture_threshold);
  matcher->setUniquenessRatio(search.uniqueness_ratio_percent);
  matcher->setDisp12MaxDiff(search.left_right_tolerance_px);
  matcher->setSpeckleWindowSize(search.speckle_size_px);
  matcher->setSpeckleRange(search.speckle_range_px);
  return match_with_opencv(pair, *matcher, search);
}

}  // namespace stereovox
