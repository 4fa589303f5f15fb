#include "stereovox/odometry/features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stereovox {
namespace {

constexpr int kBlockRadius_px = 1;  // the corner measure sums over 3 x 3 pixels
constexpr double kSobelGain = 8.0;  // sum of the positive weights of the Sobel filter, times two
constexpr int kMargin_px = kDescriptorRadius_px + 1;
// Twice as many cells as corners: many a cell is empty.
constexpr int kCellsPerCorner = 2;
// Of the nine pixels around a corner so many must have a disparity.
constexpr int kMinNeighbours = 5;

struct Corner {
  int u, v;
  float strength;
};

// Per column the sums of the products of the image gradient over the rows of a block.
struct ColumnSums {
  std::vector<int> xx, xy, yy;

  explicit ColumnSums(int width)
      : xx(static_cast<std::size_t>(width)), xy(xx.size()), yy(xx.size()) {}
};

void sum_columns(const cv::Mat1s& dx, const cv::Mat1s& dy, int v, ColumnSums& sums) {
  static_assert(kBlockRadius_px == 1, "three rows are summed");
  const std::int16_t *x0 = dx[v - 1], *x1 = dx[v], *x2 = dx[v + 1];
  const std::int16_t *y0 = dy[v - 1], *y1 = dy[v], *y2 = dy[v + 1];
  for (std::size_t u = 0; u < sums.xx.size(); ++u) {
    sums.xx[u] = x0[u] * x0[u] + x1[u] * x1[u] + x2[u] * x2[u];
    sums.xy[u] = x0[u] * y0[u] + x1[u] * y1[u] + x2[u] * y2[u];
    sums.yy[u] = y0[u] * y0[u] + y1[u] * y1[u] + y2[u] * y2[u];
  }
}

// Smallest eigenvalue of the structure tensor of each pixel, 0 at the image border.
cv::Mat1f corner_strength(const GrayImage& image) {
  cv::Mat1s dx, dy;
  cv::spatialGradient(image.pixels, dx, dy);
  cv::Mat1f strength(image.pixels.size(), 0.0F);
  ColumnSums sums(image.width());
  for (int v = kBlockRadius_px; v + kBlockRadius_px < image.height(); ++v) {
    sum_columns(dx, dy, v, sums);
    const int *xx = sums.xx.data(), *xy = sums.xy.data(), *yy = sums.yy.data();
    float* row = strength[v];
    for (int u = kBlockRadius_px; u < image.width() - kBlockRadius_px; ++u) {
      const auto a = static_cast<float>(xx[u - 1] + xx[u] + xx[u + 1]);
      const auto b = static_cast<float>(xy[u - 1] + xy[u] + xy[u + 1]);
      const auto c = static_cast<float>(yy[u - 1] + yy[u] + yy[u + 1]);
      const float half = 0.5F * (a - c);
      row[u] = 0.5F * (a + c) - std::sqrt(half * half + b * b);
    }
  }
  return strength;
}

bool is_peak(const cv::Mat1f& strength, int u, int v) {
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      if (strength(v + dv, u + du) > strength(v, u)) return false;
  return true;
}

Corner strongest_in(const cv::Mat1f& strength, const cv::Rect& cell) {
  Corner best{0, 0, -1.0F};
  for (int v = cell.y; v < cell.y + cell.height; ++v) {
    const float* row = strength[v];
    for (int u = cell.x; u < cell.x + cell.width; ++u)
      if (row[u] > best.strength) best = {u, v, row[u]};
  }
  return best;
}

int cell_size_px(const cv::Size& size, int max_count) {
  const double cells = static_cast<double>(kCellsPerCorner) * max_count;
  return std::max(2, static_cast<int>(std::lround(std::sqrt(size.area() / cells))));
}

// Weakest strength of a corner whose gradient is `gradient_px` (rms over the block).
float strength_of_gradient(double gradient_px) {
  constexpr int side = 2 * kBlockRadius_px + 1;
  return static_cast<float>(side * side * kSobelGain * kSobelGain * gradient_px * gradient_px);
}

std::vector<Corner> find_corners(const GrayImage& image, const FeatureParams& params) {
  const cv::Rect inner(kMargin_px, kMargin_px, image.width() - 2 * kMargin_px,
                       image.height() - 2 * kMargin_px);
  std::vector<Corner> corners;
  if (inner.width < 1 || inner.height < 1) return corners;
  const cv::Mat1f strength = corner_strength(image);
  const float weakest = strength_of_gradient(params.min_gradient_px);
  const int size_px = cell_size_px(inner.size(), params.max_count);
  for (int v = inner.y; v < inner.br().y; v += size_px)
    for (int u = inner.x; u < inner.br().x; u += size_px) {
      const Corner corner = strongest_in(strength, cv::Rect(u, v, size_px, size_px) & inner);
      if (corner.strength > weakest && is_peak(strength, corner.u, corner.v))
        corners.push_back(corner);
    }
  // Corners of one strength keep their order, so that the result is defined.
  std::ranges::stable_sort(corners, std::ranges::greater{}, &Corner::strength);
  return corners;
}

// The median of the disparities around a corner stands against single wrong pixels; 0 = none.
float disparity_at(const cv::Mat1f& disparity, int u, int v) {
  std::array<float, 9> around{};
  std::size_t count = 0;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du)
      if (const float d = disparity(v + dv, u + du); d > 0.0F) around[count++] = d;
  if (count < kMinNeighbours) return 0.0F;
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

PatchDescriptor describe_patch(const cv::Mat1b& image, int u, int v) {
  constexpr int r = kDescriptorRadius_px, area = (2 * r + 1) * (2 * r + 1);
  int sum = 0, sum_of_squares = 0;
  for (int y = v - r; y <= v + r; ++y)
    for (int x = u - r; x <= u + r; ++x) {
      sum += image(y, x);
      sum_of_squares += image(y, x) * image(y, x);
    }
  const double mean = static_cast<double>(sum) / area;
  const double length = std::sqrt(std::max(1.0, sum_of_squares - sum * mean));
  PatchDescriptor descriptor{};
  std::size_t i = 0;
  for (int y = v - r; y <= v + r; ++y)
    for (int x = u - r; x <= u + r; ++x)
      descriptor[i++] =
          static_cast<std::int16_t>(std::lrint(kDescriptorScale * (image(y, x) - mean) / length));
  return descriptor;
}

}  // namespace

FeatureSet extract_features(const RectifiedPair& pair, const DisparityImage& disparity,
                            const FeatureParams& params) {
  FeatureSet set;
  for (const Corner& corner : find_corners(pair.left, params)) {
    if (set.features.size() == static_cast<std::size_t>(params.max_count)) break;
    if (!pair.valid_left.empty() && pair.valid_left(corner.v, corner.u) == 0) continue;
    const float disparity_px = disparity_at(disparity.disparity_px, corner.u, corner.v);
    const float sigma_px = disparity.sigma_px(corner.v, corner.u);
    if (disparity_px <= 0.0F || !(sigma_px > 0.0F)) continue;
    set.features.push_back({Eigen::Vector2d(corner.u, corner.v), disparity_px, sigma_px});
    set.descriptors.push_back(describe_patch(pair.left.pixels, corner.u, corner.v));
  }
  return set;
}

Eigen::Vector3d position_of(const RectifiedCamera& camera, const Feature& feature) {
  return triangulate(camera, feature.pixel.x(), feature.pixel.y(), feature.disparity_px);
}

double correlation(const PatchDescriptor& a, const PatchDescriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / (kDescriptorScale * kDescriptorScale);
}

}  // namespace stereovox
