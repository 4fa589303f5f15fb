#include "stereovox/odometry/direct_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {
namespace {

constexpr int kMaxIterations = 30;
// Steps below 10 micrometres and microradians change nothing.
constexpr double kConverged = 1e-5;
constexpr double kMinDepth_m = 0.05;
constexpr int kMinPixels = 50;
constexpr double kMinCondition = 1e-12;
constexpr double kHuberSigmas = 1.345;
// Rounding to whole grey levels alone leaves a third of one.
constexpr double kMinSigma_gray = 0.3;
// Errors of the surfaces are alike over a patch of pixels, so that many count as one measurement.
constexpr double kAlikePixels = 25.0;

// A pixel of the reference image that the current image shows.
struct SeenPixel {
  double reference, current;  // brightness
  Vector6d jacobian;          // of the current brightness
};

struct Brightness {
  double value;
  Eigen::Vector2d gradient;
};

// Between the pixels; nothing outside.
std::optional<Brightness> brightness_at(const cv::Mat1b& image, const Eigen::Vector2d& pixel) {
  if (!(pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() < image.cols - 2 &&
        pixel.y() < image.rows - 2))
    return std::nullopt;
  const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
  const double a = pixel.x() - u, b = pixel.y() - v;
  const auto at = [&](int du, int dv) {
    const std::uint8_t *row = image[v + dv] + u + du, *next = image[v + dv + 1] + u + du;
    return (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * next[0] + a * next[1]);
  };
  return Brightness{at(0, 0), 0.5 * Eigen::Vector2d(at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1))};
}

std::optional<SeenPixel> see(const DirectPair& pair, int u, int v, const SE3& T_camera_reference) {
  const Eigen::Vector3d p =
      T_camera_reference * triangulate(pair.camera, u, v, pair.reference.disparity_px(v, u));
  if (p.z() < kMinDepth_m) return std::nullopt;
  const auto seen = brightness_at(pair.current.pixels, project(pair.camera.pinhole, p));
  if (!seen) return std::nullopt;
  const Eigen::Matrix<double, 2, 3> J = projection_jacobian(pair.camera, p).topRows<2>();
  const Eigen::RowVector3d slope = seen->gradient.transpose() * J;
  Vector6d jacobian;
  jacobian << -slope.transpose(), (slope * skew(p)).transpose();
  return SeenPixel{static_cast<double>(pair.reference.left.pixels(v, u)), seen->value, jacobian};
}

struct View {
  std::vector<SeenPixel> pixels;
  int known = 0;  // pixels of the reference with a disparity
};

View view_from(const DirectPair& pair, const SE3& T_reference_camera) {
  const SE3 T_camera_reference = inverse(T_reference_camera);
  View view;
  for (int v = 0; v < pair.reference.disparity_px.rows; ++v)
    for (int u = 0; u < pair.reference.disparity_px.cols; ++u) {
      if (pair.reference.disparity_px(v, u) <= 0.0F) continue;
      ++view.known;
      if (const auto pixel = see(pair, u, v, T_camera_reference)) view.pixels.push_back(*pixel);
    }
  return view;
}

// How brightness in one image follows from that in the other.
struct Exposure {
  double mean_reference = 0.0, mean_current = 0.0, gain = 1.0, correlation = 0.0, sigma = 0.0;

  double residual(const SeenPixel& pixel) const {
    return pixel.current - mean_current - gain * (pixel.reference - mean_reference);
  }
};

Exposure exposure_of(const std::vector<SeenPixel>& pixels) {
  const auto count = static_cast<double>(pixels.size());
  Exposure exposure;
  for (const SeenPixel& pixel : pixels) {
    exposure.mean_reference += pixel.reference / count;
    exposure.mean_current += pixel.current / count;
  }
  double rr = 0.0, cc = 0.0, rc = 0.0;
  for (const SeenPixel& pixel : pixels) {
    const double r = pixel.reference - exposure.mean_reference;
    const double c = pixel.current - exposure.mean_current;
    rr += r * r;
    cc += c * c;
    rc += r * c;
  }
  if (rr <= 0.0 || cc <= 0.0) return exposure;
  exposure.correlation = rc / std::sqrt(rr * cc);
  exposure.gain = rc / rr;
  exposure.sigma = std::sqrt((cc - rc * rc / rr) / count);
  return exposure;
}

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

NormalEquations normal_equations(const std::vector<SeenPixel>& pixels, const Exposure& exposure) {
  const double limit = kHuberSigmas * std::max(kMinSigma_gray, exposure.sigma);
  NormalEquations equations;
  for (const SeenPixel& pixel : pixels) {
    const double residual = exposure.residual(pixel);
    const double weight = std::abs(residual) <= limit ? 1.0 : limit / std::abs(residual);
    equations.H += weight * pixel.jacobian * pixel.jacobian.transpose();
    equations.g += weight * residual * pixel.jacobian;
  }
  return equations;
}

// False when the brightness does not fix the motion.
bool converge(const DirectPair& pair, SE3& T_reference_camera) {
  for (int i = 0; i < kMaxIterations; ++i) {
    const View view = view_from(pair, T_reference_camera);
    if (static_cast<int>(view.pixels.size()) < kMinPixels) return false;
    const NormalEquations equations = normal_equations(view.pixels, exposure_of(view.pixels));
    const Eigen::LDLT<Matrix6d> factors(equations.H);
    if (!(factors.rcond() > kMinCondition)) return false;
    const Vector6d step = factors.solve(-equations.g);
    T_reference_camera = T_reference_camera * exp(step);
    if (step.norm() < kConverged) break;
  }
  return true;
}

}  // namespace

DirectAlignment align_directly(std::span<const DirectPair> coarse_to_fine, const SE3& start) {
  DirectAlignment result{.T_reference_camera = start};
  result.covariance.setConstant(std::numeric_limits<double>::infinity());
  for (const DirectPair& pair : coarse_to_fine)
    if (!converge(pair, result.T_reference_camera)) return result;
  const View view = view_from(coarse_to_fine.back(), result.T_reference_camera);
  const Exposure exposure = exposure_of(view.pixels);
  result.overlap = static_cast<double>(view.pixels.size()) / std::max(1, view.known);
  result.correlation = exposure.correlation;
  const Eigen::LDLT<Matrix6d> factors(normal_equations(view.pixels, exposure).H);
  const double sigma = std::max(kMinSigma_gray, exposure.sigma);
  if (factors.rcond() > kMinCondition)
    result.covariance = kAlikePixels * sigma * sigma * factors.solve(Matrix6d::Identity());
  return result;
}

}  // namespace stereovox
