// Small islands of disparity are mostly wrong.
#pragma once

#include <opencv2/core/mat.hpp>

namespace stereovox {

// Sets disparities, in any unit, to 0 in islands with fewer than `min_count` pixels that count:
// those where `counts` is not 0. Disparities that are not > 0 belong to no island. An island is
// what can be reached by steps to the four neighbours whose disparities differ by at most
// `max_step`. Linear in the number of pixels.
void remove_speckles(cv::Mat1s& disparity, const cv::Mat1b& counts, int min_count, int max_step);

}  // namespace stereovox
