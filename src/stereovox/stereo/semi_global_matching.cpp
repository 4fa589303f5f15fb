#include "stereovox/stereo/semi_global_matching.h"

#include <opencv2/calib3d.hpp>

#include "stereovox/core/error.h"
#include "stereovox/stereo/opencv_matching.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const SemiGlobalMatchingParams& p) {
  if (p.smoothness_large <= p.smoothness_small)
    throw UsageError("matcher.smoothness_large must exceed matcher.smoothness_small");
  const int range_px = round_up_to_16(p.disparity_range_px);
  const auto matcher = cv::StereoSGBM::create(
      p.min_disparity_px, range_px, p.block_size_px | 1, p.smoothness_small, p.smoothness_large,
      p.left_right_tolerance_px, p.prefilter_cap, p.uniqueness_ratio_percent, p.speckle_size_px,
      p.speckle_range_px, cv::StereoSGBM::MODE_SGBM_3WAY);
  return match_with_opencv(pair, *matcher, p.min_disparity_px + range_px, p.sigma_px);
}

}  // namespace stereovox
