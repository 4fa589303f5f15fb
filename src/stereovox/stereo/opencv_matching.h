// What OpenCV's matchers have in common: they leave the left border empty, count in sixteenths of a
// pixel, and know no valid-pixel masks.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"

namespace cv {
class StereoMatcher;
}

namespace stereovox {

inline int round_up_to_16(int value) { return (value + 15) / 16 * 16; }

// Runs `matcher` on images extended to the left by `max_disparity_px`, so that the left border is
// matched too, and keeps the disparities that are > 0 and join two recorded pixels.
DisparityImage match_with_opencv(const RectifiedPair& pair, cv::StereoMatcher& matcher,
                                 int max_disparity_px, double sigma_px);

}  // namespace stereovox
