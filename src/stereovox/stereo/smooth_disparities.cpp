#include "stereovox/stereo/smooth_disparities.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/match_confidence.h"

namespace stereovox {
namespace {

using Step = std::int16_t;
using Row = std::vector<Step>;

constexpr int kReach_px = 4;
constexpr int kMembers = 2 * kReach_px + 1;
constexpr int kRowsAtOnce = 16;

// The middle one of three.
Step middle(Step a, Step b, Step c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

// The rows about a pixel's row, sorted column by column, with one more column on either side.
struct SortedColumns {
  Row low, mid, high;
  explicit SortedColumns(int width) : low(width + 2), mid(width + 2), high(width + 2) {}

  void sort(const Step* above, const Step* here, const Step* below, int width) {
    Step *const l = low.data() + 1, *const m = mid.data() + 1, *const h = high.data() + 1;
    for (int u = 0; u < width; ++u) {
      const Step a = above[u], b = here[u], c = below[u];
      l[u] = std::min(a, std::min(b, c));
      m[u] = middle(a, b, c);
      h[u] = std::max(a, std::max(b, c));
    }
    for (Row* const row : {&low, &mid, &high}) {
      row->front() = (*row)[1];
      row->back() = row->rbegin()[1];
    }
  }
};

void fill_medians(const SortedColumns& columns, int width, Step* out) {
  const Step *const l = columns.low.data(), *const m = columns.mid.data();
  const Step* const h = columns.high.data();
  for (int u = 0; u < width; ++u)
    out[u] = middle(std::max(l[u], std::max(l[u + 1], l[u + 2])), middle(m[u], m[u + 1], m[u + 2]),
                    std::min(h[u], std::min(h[u + 1], h[u + 2])));
}

// The step from `here` to `there`, or none when they belong to different surfaces. Steps wrap
// around, but never to small ones: disparities have 15 bits.
Step step_on_surface(Step here, Step there) {
  const auto step = static_cast<Step>(there - here);
  return step <= kStepsPerPixel && step >= -kStepsPerPixel ? step : Step{0};
}

// Rounded to the nearest.
Step mean_step(Step sum) {
  constexpr int kBits = 16, kReciprocal = ((1 << kBits) + kMembers / 2) / kMembers;
  return static_cast<Step>((sum * kReciprocal + (1 << (kBits - 1))) >> kBits);
}

// `members` are rows of the same surface, the pixel's own in the middle.
void fill_means(const std::array<const Step*, kMembers>& members, int width, Step* out) {
  const Step* const own = members[kReach_px];
  for (int u = 0; u < width; ++u) {
    Step sum = 0;
    for (int k = 0; k < kMembers; ++k)
      sum = static_cast<Step>(sum + step_on_surface(own[u], members[k][u]));
    out[u] = static_cast<Step>(own[u] + mean_step(sum));
  }
}

const Step* row_or_border(const cv::Mat1s& image, int v) {
  return image[std::clamp(v, 0, image.rows - 1)];
}

void smooth_row_along(const cv::Mat1s& in, int v, SortedColumns& columns, Row& padded, Step* out) {
  const int width = in.cols;
  columns.sort(row_or_border(in, v - 1), in[v], row_or_border(in, v + 1), width);
  fill_medians(columns, width, padded.data() + kReach_px);
  std::fill_n(padded.begin(), kReach_px, padded[kReach_px]);
  std::fill_n(padded.rbegin(), kReach_px, padded.rbegin()[kReach_px]);
  std::array<const Step*, kMembers> members;
  for (int k = 0; k < kMembers; ++k) members[k] = padded.data() + k;
  fill_means(members, width, out);
}

void smooth_row_across(const cv::Mat1s& in, int v, Step* out) {
  std::array<const Step*, kMembers> members;
  for (int k = 0; k < kMembers; ++k) members[k] = row_or_border(in, v + k - kReach_px);
  fill_means(members, in.cols, out);
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
