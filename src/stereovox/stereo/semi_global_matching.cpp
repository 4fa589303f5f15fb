#include "stereovox/stereo/semi_global_matching.h"

#include <opencv2/calib3d.hpp>

#include "stereovox/core/error.h"
#include "stereovox/stereo/opencv_matching.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const SemiGlobalMatchingParams& p,
                     int /*threads*/) {
  if (p.smoothness_large <= p.smoothness_small)
    throw UsageError("matcher.smoothness_large must exceed matcher.smoothness_small");
  const DisparitySearch& search = p.search;
  const auto matcher = cv::StereoSGBM::create(
      search.min_disparity_px, search.range_px(), p.block_size_px | 1, p.smoothness_small,
      p.smoothness_large, search.left_right_tolerance_px, search.prefilter_cap,
      search.uniqueness_ratio_percent, search.speckle_size_px, search.speckle_range_px,
      cv::StereoSGBM::MODE_SGBM_3WAY);
  return match_with_opencv(pair, *matcher, search);
}

}  // namespace stereovox
