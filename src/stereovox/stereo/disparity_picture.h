// Disparity for people: near is warm, far is cold, none is black.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/core/image.h"

namespace stereovox {

// BGR, same size; the colours span the 1st to the 99th percentile of the disparities.
cv::Mat3b draw_disparity(const DisparityImage& disparity);

}  // namespace stereovox
