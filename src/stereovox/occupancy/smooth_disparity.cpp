#include "stereovox/occupancy/smooth_disparity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "stereovox/core/parallel.h"

namespace stereovox {
namespace {

// Neither larger nor smaller than any bound.
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Pixels of a row, a few vectors of them, with the bounds of what belongs to their surfaces.
struct Stretch {
  static constexpr int kSize = 64;

  std::array<float, kSize> low, high, sum, count;
};

// The disparities with `radius` more pixels on each side, kNone where nothing was measured.
cv::Mat1f padded(const DisparityImage& image, int radius) {
  cv::Mat1f out(image.height() + 2 * radius, image.width() + 2 * radius + Stretch::kSize, kNone);
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      const float disparity_px = image.disparity_px(v, u);
      if (disparity_px > 0.0F && std::isfinite(disparity_px))
        out(v + radius, u + radius) = disparity_px;
    }
  return out;
}

// Adds the pairs of pixels that differ from the middle by one offset.
struct AddPair {
  [[gnu::always_inline]] void operator()(const float* before, const float* after,
                                         Stretch& s) const {
    for (std::size_t i = 0; i < Stretch::kSize; ++i) {
      const float a = before[i], b = after[i];
      const bool is_one_surface =
          (a >= s.low[i]) & (b >= s.low[i]) & (a <= s.high[i]) & (b <= s.high[i]);
      s.sum[i] += is_one_surface ? a + b : 0.0F;
      s.count[i] += is_one_surface ? 2.0F : 0.0F;
    }
  }
};

// All pairs of the window. The rows of the padded image are `stride` apart.
struct AddWindow {
  [[gnu::always_inline]] void operator()(const float* middle, int stride, int radius,
                                         Stretch& s) const {
    for (int down = 0; down <= radius; ++down)
      for (int right = down == 0 ? 1 : -radius; right <= radius; ++right) {
        const int step = down * stride + right;
        AddPair{}(middle - step, middle + step, s);
      }
  }
};

void begin(const float* middle, const float* sigma_px, int count, float gate_sigmas, Stretch& s) {
  s.low.fill(kNone);
  s.high.fill(kNone);
  s.count.fill(1.0F);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float gate_px = gate_sigmas * sigma_px[i];
    s.low[at] = middle[i] - gate_px;
    s.high[at] = middle[i] + gate_px;
    s.sum[at] = middle[i];
  }
}

void smooth_row(const DisparityImage& image, const cv::Mat1f& wide, const SmoothingParams& params,
                int v, VectorTarget target, cv::Mat1f& out) {
  const int radius = params.radius_px, stride = static_cast<int>(wide.step1());
  Stretch s{};
  for (int first = 0; first < image.width(); first += Stretch::kSize) {
    const int count = std::min(Stretch::kSize, image.width() - first);
    const float* const middle = wide.ptr<float>(v + radius) + radius + first;
    begin(middle, image.sigma_px.ptr<float>(v) + first, count,
          static_cast<float>(params.gate_sigmas), s);
    run_on(target, AddWindow{}, middle, stride, radius, s);
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (s.count[at] > 1.0F) out(v, first + i) = s.sum[at] / s.count[at];
    }
  }
}

}  // namespace

DisparityImage smoothed(const DisparityImage& image, const SmoothingParams& params,
                        std::span<const int> rows, int threads, VectorTarget target) {
  if (params.radius_px == 0) return image;
  if (image.sigma_px.size() != image.disparity_px.size())
    throw std::logic_error("smoothed: disparities and standard deviations differ in size");
  const cv::Mat1f wide = padded(image, params.radius_px);
  DisparityImage out = image;
  out.disparity_px = image.disparity_px.clone();
  parallel_for(0, static_cast<int>(rows.size()), threads, [&](int i) {
    smooth_row(image, wide, params, rows[static_cast<std::size_t>(i)], target, out.disparity_px);
  });
  return out;
}

}  // namespace stereovox
