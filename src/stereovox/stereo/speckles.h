// Small islands of disparity are mostly wrong.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stereovox {

// Sets disparities to 0 in islands of fewer than `min_size_px` pixels; disparities that are not > 0
// belong to none. An island is what can be reached by steps to the four neighbours whose
// disparities differ by at most `max_step_px`. Linear in the number of pixels.
void remove_speckles(cv::Mat1f& disparity_px, int min_size_px, float max_step_px);

}  // namespace stereovox
