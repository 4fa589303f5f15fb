#include "stereovox/stereo/smooth_disparities.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/row_kernels.h"

namespace stereovox {
namespace {

using Step = std::int16_t;
using Row = std::vector<Step>;

constexpr int kReach_px = kSmoothReach_px, kMembers = kSmoothMembers;
constexpr int kRowsAtOnce = 16;

struct SortedColumns {
  Row low, mid, high;
  explicit SortedColumns(int width) : low(width + 2), mid(width + 2), high(width + 2) {}
  SortedRows rows() { return {low.data(), mid.data(), high.data()}; }
};

const Step* row_or_border(const cv::Mat1s& image, int v) {
  return image[std::clamp(v, 0, image.rows - 1)];
}

void smooth_row_along(const cv::Mat1s& in, int v, SortedColumns& columns, Row& padded, Step* out) {
  const int width = in.cols;
  const RowKernels& kernels = fastest_row_kernels();
  kernels.sort_columns(row_or_border(in, v - 1), in[v], row_or_border(in, v + 1), width,
                       columns.rows());
  kernels.medians(columns.rows(), width, padded.data() + kReach_px);
  std::fill_n(padded.begin(), kReach_px, padded[kReach_px]);
  std::fill_n(padded.rbegin(), kReach_px, padded.rbegin()[kReach_px]);
  std::array<const Step*, kMembers> members;
  for (int k = 0; k < kMembers; ++k) members[k] = padded.data() + k;
  kernels.means(members.data(), width, out);
}

void smooth_row_across(const cv::Mat1s& in, int v, Step* out) {
  std::array<const Step*, kMembers> members;
  for (int k = 0; k < kMembers; ++k) members[k] = row_or_border(in, v + k - kReach_px);
  fastest_row_kernels().means(members.data(), in.cols, out);
}

}  // namespace

void smooth_disparities(cv::Mat1s& disparity, int threads) {
  cv::Mat1s along(disparity.size());
  const int chunks = (disparity.rows + kRowsAtOnce - 1) / kRowsAtOnce;
  const auto end_of = [&](int chunk) { return std::min((chunk + 1) * kRowsAtOnce, along.rows); };
  parallel_for(0, chunks, threads, [&](int chunk) {
    SortedColumns columns(along.cols);
    Row padded(along.cols + 2 * kReach_px);
    for (int v = chunk * kRowsAtOnce; v < end_of(chunk); ++v)
      smooth_row_along(disparity, v, columns, padded, along[v]);
  });
  parallel_for(0, chunks, threads, [&](int chunk) {
    for (int v = chunk * kRowsAtOnce; v < end_of(chunk); ++v)
      smooth_row_across(along, v, disparity[v]);
  });
}

}  // namespace stereovox
