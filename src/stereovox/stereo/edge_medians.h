// Windows that straddle the edge of a surface mostly match the nearer side, which so grows beyond
// its edge. The image knows better where it ends.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stereovox {

// Where the disparities of a 7 x 7 window span more than 1.5 px, the one in the middle becomes
// their median, weighed by how alike the pixels look: max(0, contrast_gray - |difference of
// brightness|) (the weighted median of Ma et al., ICCV 2013; of equals the smaller). In steps of
// 1 / kStepsPerPixel; those that are not > 0 are none: they do not count and stay. contrast_gray 0
// to 255; with 0 nothing changes.
void settle_edges(const cv::Mat1b& left, int contrast_gray, cv::Mat1s& disparity, int threads);

}  // namespace stereovox
