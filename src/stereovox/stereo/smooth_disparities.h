// Takes the noise out of disparities and keeps their edges.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stereovox {

// Each disparity, in steps of 1 / kStepsPerPixel, becomes the median of its 3 x 3 neighbourhood;
// then the mean of the 9 of its row, and of the 9 of its column, in which those that differ by more
// than a pixel count as the pixel itself does (the sigma filter of Lee, 1983, along rows and
// columns). Images repeat their borders.
void smooth_disparities(cv::Mat1s& disparity, int threads);

}  // namespace stereovox
