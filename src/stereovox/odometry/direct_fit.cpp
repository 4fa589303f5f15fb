#include "stereovox/odometry/direct_fit.h"

#include <cmath>
#include <cstddef>

namespace stereovox {
namespace {

using namespace direct;

// The surroundings whose mean is taken away reach this part of the width in each direction.
constexpr int kReachesPerWidth = 16;
// Sums run in lanes side by side, so that they are the same with any width of vectors.
constexpr std::size_t kLanes = 8;
using Lanes = std::array<float, kLanes>;
constexpr std::size_t kTwist = 6, kProducts = kTwist * (kTwist + 1) / 2;
// As many are added as float before they go on as double.
constexpr std::size_t kBlock = 64 * kLanes;

std::size_t whole_blocks(std::size_t count) { return (count + kBlock - 1) / kBlock * kBlock; }

struct Detail {
  float value, dx, dy;
};

// Between the pixels, as a mean of the nearest four, and its central differences.
class Between {
 public:
  explicit Between(const cv::Mat1b& image)
      : data_(image.data), step_(static_cast<std::ptrdiff_t>(image.step[0])) {
    const cv::Rect inside = with_surroundings(image);
    left_ = static_cast<float>(inside.x);
    top_ = static_cast<float>(inside.y);
    right_ = static_cast<float>(inside.br().x - 1);
    bottom_ = static_cast<float>(inside.br().y - 1);
  }
  bool shows(float x, float y) const {
    return x >= left_ && y >= top_ && x < right_ && y < bottom_;
  }

  Detail at(float x, float y) const {
    const int u = static_cast<int>(x), v = static_cast<int>(y);
    const float a = x - static_cast<float>(u), b = y - static_cast<float>(v);
    const std::uint8_t* row = data_ + v * step_ + u;
    const float above = across(row - step_, a), here = across(row, a);
    const float below = across(row + step_, a), next = across(row + 2 * step_, a);
    const float slope = slope_across(row, a), next_slope = slope_across(row + step_, a);
    return {here + b * (below - here), 0.5F * (slope + b * (next_slope - slope)),
            0.5F * ((1.0F - b) * (below - above) + b * (next - here))};
  }

 private:
  static float across(const std::uint8_t* p, float a) {
    return static_cast<float>(p[0]) + a * static_cast<float>(p[1] - p[0]);
  }
  static float slope_across(const std::uint8_t* p, float a) {
    return (1.0F - a) * static_cast<float>(p[1] - p[-1]) + a * static_cast<float>(p[2] - p[0]);
  }

  const std::uint8_t* data_;
  std::ptrdiff_t step_;
  float left_, top_, right_, bottom_;
};

// What the exposure leaves unexplained, in standard deviations.
struct Residuals {
  float offset, gain, per_sigma;

  float of(float reference, float current) const {
    return (current - offset - gain * reference) * per_sigma;
  }
  // Large ones count linearly only.
  float weight(float residual) const {
    constexpr auto kHuber = static_cast<float>(kHuberSigmas);
    return kHuber / std::max(kHuber, std::abs(residual)) * per_sigma;
  }
};

// Sums of one block of pixels.
struct LaneSums {
  std::array<Lanes, kProducts> H{};
  std::array<Lanes, kTwist> g{};

  // Of the pixels from `first` on, one in each lane.
  template <class Columns>
  void add(const Residuals& residuals, const Columns& columns, std::size_t first) {
    Lanes residual, weight, weighted;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      residual[lane] = residuals.of(columns.reference[first + lane], columns.current[first + lane]);
      weight[lane] = residuals.weight(residual[lane]);
    }
    std::size_t product = 0;
    for (std::size_t row = 0; row < kTwist; ++row) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        weighted[lane] = weight[lane] * columns.jacobian[row][first + lane];
        g[row][lane] += weighted[lane] * residual[lane];
        weighted[lane] *= residuals.per_sigma;
      }
      for (std::size_t column = 0; column <= row; ++column, ++product)
        for (std::size_t lane = 0; lane < kLanes; ++lane)
          H[product][lane] += weighted[lane] * columns.jacobian[column][first + lane];
    }
  }
};

double sum_of(const Lanes& lanes) {
  double sum = 0.0;
  for (const float value : lanes) sum += static_cast<double>(value);
  return sum;
}

// The lower triangle, row by row.
void add(const LaneSums& sums, DirectFit& fit) {
  std::size_t product = 0;
  for (std::size_t row = 0; row < kTwist; ++row) {
    fit.g[static_cast<Eigen::Index>(row)] += sum_of(sums.g[row]);
    for (std::size_t column = 0; column <= row; ++column)
      fit.H(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) +=
          sum_of(sums.H[product++]);
  }
}

// Of the details in view, less that of no difference.
struct DetailSums {
  std::size_t count = 0;
  double r = 0.0, c = 0.0, rr = 0.0, cc = 0.0, rc = 0.0;

  void add(float reference, float current) {
    const double dr = static_cast<double>(reference) - kNoDetail;
    const double dc = static_cast<double>(current) - kNoDetail;
    ++count;
    r += dr;
    c += dc;
    rr += dr * dr;
    cc += dc * dc;
    rc += dr * dc;
  }
};

// How the current detail follows from the reference: offset + gain * reference.
struct Exposure {
  double correlation = 0.0, sigma = 0.0, gain = 1.0, offset = 0.0;
};

Exposure exposure_of(const DetailSums& sums) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, sums.count));
  const double rr = sums.rr - sums.r * sums.r / count, cc = sums.cc - sums.c * sums.c / count;
  const double rc = sums.rc - sums.r * sums.c / count;
  Exposure exposure;
  if (std::min(rr, cc) > kNoVariance * count) {
    exposure.correlation = rc / std::sqrt(rr * cc);
    exposure.gain = rc / rr;
    exposure.sigma = std::sqrt(std::max(0.0, cc - rc * rc / rr) / count);
  }
  exposure.offset = kNoDetail + sums.c / count - exposure.gain * (kNoDetail + sums.r / count);
  return exposure;
}

// The same numbers as in DirectPair and SE3, as float.
struct Camera {
  float fx_px, fy_px, cx_px, cy_px, baseline_m;

  explicit Camera(const RectifiedCamera& camera)
      : fx_px(static_cast<float>(camera.pinhole.fx_px)),
        fy_px(static_cast<float>(camera.pinhole.fy_px)),
        cx_px(static_cast<float>(camera.pinhole.cx_px)),
        cy_px(static_cast<float>(camera.pinhole.cy_px)),
        baseline_m(static_cast<float>(camera.baseline_m)) {}
};

struct Place {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;

  explicit Place(const SE3& T_reference_camera)
      : R(inverse(T_reference_camera).rotation.toRotationMatrix().cast<float>()),
        t(inverse(T_reference_camera).translation.cast<float>()) {}

  Eigen::Vector3f in_camera(float x, float y, float z) const {
    return {R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + t[0],
            R(1, 0) * x + R(1, 1) * y + R(1, 2) * z + t[1],
            R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + t[2]};
  }
};

}  // namespace

// `slope`: by how much the detail grows with the point's place in the camera.
inline void DirectFitter::Columns::put(std::size_t n, float reference_detail, float current_detail,
                                       const Eigen::Vector3f& slope, const Eigen::Vector3f& p) {
  reference[n] = reference_detail;
  current[n] = current_detail;
  jacobian[0][n] = -slope[0];
  jacobian[1][n] = -slope[1];
  jacobian[2][n] = -slope[2];
  jacobian[3][n] = slope[1] * p[2] - slope[2] * p[1];
  jacobian[4][n] = slope[2] * p[0] - slope[0] * p[2];
  jacobian[5][n] = slope[0] * p[1] - slope[1] * p[0];
}

// An eye of the current camera, and what it has seen so far.
struct DirectFitter::Eye {
  const Between image;
  const float to_the_right_m;
  Columns& columns;
  DetailSums sums = {};

  void see(const Camera& camera, const Eigen::Vector3f& p, float nearness, float reference) {
    const float x = p.x() - to_the_right_m, y = p.y();
    const float u = camera.fx_px * x * nearness + camera.cx_px;
    const float v = camera.fy_px * y * nearness + camera.cy_px;
    if (!image.shows(u, v)) return;
    const Detail detail = image.at(u, v);
    const float sx = detail.dx * camera.fx_px * nearness, sy = detail.dy * camera.fy_px * nearness;
    columns.put(sums.count, reference, detail.value, {sx, sy, -(sx * x + sy * y) * nearness}, p);
    sums.add(reference, detail.value);
  }
};

void DirectFitter::Columns::resize(std::size_t size) {
  for (auto& column : jacobian) column.resize(size);
  reference.resize(size);
  current.resize(size);
}

// What lies beyond the pixels in view changes nothing.
void DirectFitter::Columns::fill_up(std::size_t count) {
  const auto from = static_cast<std::ptrdiff_t>(count);
  const auto to = static_cast<std::ptrdiff_t>(whole_blocks(count));
  for (auto& column : jacobian) std::fill(column.begin() + from, column.begin() + to, 0.0F);
}

int surroundings_px(const cv::Mat1b& image) { return std::max(1, image.cols / kReachesPerWidth); }

cv::Rect with_surroundings(const cv::Mat1b& image) {
  const int margin = surroundings_px(image);
  return {margin, margin, std::max(0, image.cols - 2 * margin),
          std::max(0, image.rows - 2 * margin)};
}

DirectFitter::DirectFitter(const DirectPair& pair) : pair_(pair) {
  const SurfaceLevel& reference = pair.reference;
  const cv::Rect inside = with_surroundings(reference.detail.left);
  for (int v = inside.y; v < inside.br().y; ++v)
    for (int u = inside.x; u < inside.br().x; ++u) {
      const float disparity_px = reference.disparity_px(v, u);
      if (disparity_px <= 0.0F) continue;
      const Eigen::Vector3f p = triangulate(pair.camera, u, v, disparity_px).cast<float>();
      x_m_.push_back(p.x());
      y_m_.push_back(p.y());
      z_m_.push_back(p.z());
      detail_.push_back(static_cast<float>(reference.detail.left(v, u)));
    }
  for (Columns* columns : {&left_, &right_}) columns->resize(whole_blocks(detail_.size()));
}

DirectFit DirectFitter::at(const SE3& T_reference_camera) {
  constexpr auto kMinDepth = static_cast<float>(kMinDepth_m);
  const Camera camera(pair_.camera);
  const Place place(T_reference_camera);
  Eye left{Between(pair_.current.left), 0.0F, left_};
  Eye right{Between(pair_.current.right), camera.baseline_m, right_};
  for (std::size_t i = 0; i < detail_.size(); ++i) {
    const Eigen::Vector3f p = place.in_camera(x_m_[i], y_m_[i], z_m_[i]);
    if (!(p.z() >= kMinDepth)) continue;
    const float nearness = 1.0F / p.z();
    left.see(camera, p, nearness, detail_[i]);
    right.see(camera, p, nearness, detail_[i]);
  }
  DirectFit fit;
  fit.known = static_cast<int>(detail_.size());
  fit.left = add(left, fit);
  fit.right = add(right, fit);
  fit.H.triangularView<Eigen::StrictlyUpper>() = fit.H.transpose();
  return fit;
}

EyeFit DirectFitter::add(Eye& eye, DirectFit& fit) {
  const Exposure exposure = exposure_of(eye.sums);
  const Residuals residuals{static_cast<float>(exposure.offset), static_cast<float>(exposure.gain),
                            static_cast<float>(1.0 / std::max(kMinSigma, exposure.sigma))};
  eye.columns.fill_up(eye.sums.count);
  for (std::size_t begin = 0; begin < eye.sums.count; begin += kBlock) {
    LaneSums sums;
    for (std::size_t i = begin; i < begin + kBlock; i += kLanes)
      sums.add(residuals, eye.columns, i);
    stereovox::add(sums, fit);
  }
  return {static_cast<int>(eye.sums.count), exposure.correlation, exposure.sigma};
}

}  // namespace stereovox
