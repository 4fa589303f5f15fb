// What OpenCV's matchers have in common: they leave the left border empty, count in sixteenths of a
// pixel, and know no valid-pixel masks.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/disparity_search.h"

namespace cv {
class StereoMatcher;
}

namespace stereovox {

// Runs `matcher`, which is set up as `search` says, on images extended to the left by the largest
// disparity, so that the left border is matched too, and keeps the disparities that are > 0 and
// join two recorded pixels.
DisparityImage match_with_opencv(const RectifiedPair& pair, cv::StereoMatcher& matcher,
                                 const DisparitySearch& search);

}  // namespace stereovox
