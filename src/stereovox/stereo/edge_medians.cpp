#include "stereovox/stereo/edge_medians.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/row_kernels.h"

namespace stereovox {

void settle_edges(const cv::Mat1b& left, int contrast_gray, cv::Mat1s& disparity, int threads) {
  if (contrast_gray == 0) return;
  constexpr int kReach = kMedianReach_px, kRowsAtOnce = 16;
  const int width = disparity.cols, height = disparity.rows;
  cv::Mat1s around;  // nothing lies beyond the border
  cv::Mat1b gray;
  const int to_the_right = kReach + kMedianSlack;
  cv::copyMakeBorder(disparity, around, kReach, kReach, kReach, to_the_right, cv::BORDER_CONSTANT,
                     cv::Scalar(0));
  cv::copyMakeBorder(left, gray, kReach, kReach, kReach, to_the_right, cv::BORDER_CONSTANT,
                     cv::Scalar(0));
  parallel_for(0, (height + kRowsAtOnce - 1) / kRowsAtOnce, threads, [&](int chunk) {
    for (int v = chunk * kRowsAtOnce; v < std::min((chunk + 1) * kRowsAtOnce, height); ++v) {
      MedianRows rows = {.contrast_gray = contrast_gray};
      for (int k = 0; k < kMedianSide_px; ++k) {
        rows.disparity[k] = around[v + k];
        rows.gray[k] = gray[v + k];
      }
      fastest_row_kernels().edge_medians(rows, width, disparity[v]);
    }
  });
}

}  // namespace stereovox
