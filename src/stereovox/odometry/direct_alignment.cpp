#include "stereovox/odometry/direct_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {
namespace {

constexpr int kMaxIterations = 30;
// Steps below 10 micrometres and microradians change nothing.
constexpr double kConverged = 1e-5;
constexpr double kMinDepth_m = 0.05;
constexpr std::size_t kMinPixels = 50;
constexpr double kMinCondition = 1e-12;
constexpr double kHuberSigmas = 1.345;
// Rounding alone leaves a third of a step.
constexpr double kMinSigma = 0.3;
// Rounding of sums leaves less than this of none.
constexpr double kNoVariance = 1e-6;
// The surroundings whose mean is taken away reach this part of the width in each direction.
constexpr int kReachesPerWidth = 16;
const Matrix6d kUnknown = Matrix6d::Constant(std::numeric_limits<double>::infinity());
// Errors of the surfaces are alike over a patch of pixels, so that many count as one measurement.
constexpr double kAlikePixels = 100.0;

enum Eye { kLeft, kRight };
constexpr std::array kEyes = {kLeft, kRight};

// A pixel of the reference image that the current image shows.
struct SeenPixel {
  double reference, current;  // detail
  Vector6d jacobian;          // of the current detail
};

struct Detail {
  double value;
  Eigen::Vector2d gradient;
};

// Half the side, in pixels, of the square that counts as the surroundings of a pixel.
int surroundings_px(const cv::Mat1b& image) { return std::max(1, image.cols / kReachesPerWidth); }

// Pixels whose surroundings the image shows; the detail of others depends on where it ends.
cv::Rect with_surroundings(const cv::Mat1b& image) {
  const int margin = surroundings_px(image);
  return {margin, margin, std::max(0, image.cols - 2 * margin),
          std::max(0, image.rows - 2 * margin)};
}

// Between the pixels; nothing outside.
std::optional<Detail> detail_at(const cv::Mat1b& image, const Eigen::Vector2d& pixel) {
  const cv::Rect inside = with_surroundings(image);
  if (!(pixel.x() >= inside.x && pixel.y() >= inside.y && pixel.x() < inside.br().x - 1 &&
        pixel.y() < inside.br().y - 1))
    return std::nullopt;
  const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
  const double a = pixel.x() - u, b = pixel.y() - v;
  const auto at = [&](int du, int dv) {
    const std::uint8_t *row = image[v + dv] + u + du, *next = image[v + dv + 1] + u + du;
    return (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * next[0] + a * next[1]);
  };
  return Detail{at(0, 0), 0.5 * Eigen::Vector2d(at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1))};
}

const cv::Mat1b& image_of(const DetailPair& pair, Eye eye) {
  return eye == kLeft ? pair.left : pair.right;
}

std::optional<SeenPixel> see(const DirectPair& pair, Eye eye, std::uint8_t reference,
                             const Eigen::Vector3d& p_camera) {
  const int column = eye == kLeft ? 0 : 2;
  const Eigen::Vector3d pixels = project_stereo(pair.camera, p_camera);
  const auto seen = detail_at(image_of(pair.current, eye), {pixels[column], pixels[1]});
  if (!seen) return std::nullopt;
  const Eigen::Matrix3d J = projection_jacobian(pair.camera, p_camera);
  const Eigen::RowVector3d slope =
      seen->gradient.x() * J.row(column) + seen->gradient.y() * J.row(1);
  Vector6d jacobian;
  jacobian << -slope.transpose(), (slope * skew(p_camera)).transpose();
  return SeenPixel{static_cast<double>(reference), seen->value, jacobian};
}

struct View {
  std::array<std::vector<SeenPixel>, 2> eyes;
  int known = 0;  // pixels of the reference with a disparity

  double overlap() const {
    return static_cast<double>(std::min(eyes[kLeft].size(), eyes[kRight].size())) /
           std::max(1, known);
  }
  bool is_enough() const {
    return std::ranges::all_of(eyes,
                               [](const auto& pixels) { return pixels.size() >= kMinPixels; });
  }
};

View view_from(const DirectPair& pair, const SE3& T_reference_camera) {
  const SE3 T_camera_reference = inverse(T_reference_camera);
  View view;
  const cv::Rect inside = with_surroundings(pair.reference.detail.left);
  for (int v = inside.y; v < inside.br().y; ++v)
    for (int u = inside.x; u < inside.br().x; ++u) {
      const float disparity_px = pair.reference.disparity_px(v, u);
      if (disparity_px <= 0.0F) continue;
      ++view.known;
      const Eigen::Vector3d p = T_camera_reference * triangulate(pair.camera, u, v, disparity_px);
      if (p.z() < kMinDepth_m) continue;
      for (const Eye eye : kEyes)
        if (const auto pixel = see(pair, eye, pair.reference.detail.left(v, u), p))
          view.eyes[eye].push_back(*pixel);
    }
  return view;
}

// How the detail of one image follows from that of the other.
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
  if (std::min(rr, cc) <= kNoVariance * count) return exposure;
  exposure.correlation = rc / std::sqrt(rr * cc);
  exposure.gain = rc / rr;
  exposure.sigma = std::sqrt((cc - rc * rc / rr) / count);
  return exposure;
}

struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
};

void add(NormalEquations& equations, const std::vector<SeenPixel>& pixels) {
  const Exposure exposure = exposure_of(pixels);
  const double sigma = std::max(kMinSigma, exposure.sigma);
  for (const SeenPixel& pixel : pixels) {
    const double residual = exposure.residual(pixel) / sigma;
    const double weight =
        std::min(1.0, kHuberSigmas / std::max(kHuberSigmas, std::abs(residual))) / sigma;
    equations.H += (weight / sigma) * pixel.jacobian * pixel.jacobian.transpose();
    equations.g += weight * residual * pixel.jacobian;
  }
}

NormalEquations normal_equations(const View& view) {
  NormalEquations equations;
  for (const Eye eye : kEyes) add(equations, view.eyes[eye]);
  return equations;
}

// False when the detail does not fix the motion.
bool converge(const DirectPair& pair, SE3& T_reference_camera) {
  for (int i = 0; i < kMaxIterations; ++i) {
    const View view = view_from(pair, T_reference_camera);
    if (!view.is_enough()) return false;
    const NormalEquations equations = normal_equations(view);
    const Eigen::LDLT<Matrix6d> factors(equations.H);
    if (!(factors.rcond() > kMinCondition)) return false;
    const Vector6d step = factors.solve(-equations.g);
    T_reference_camera = T_reference_camera * exp(step);
    if (step.norm() < kConverged) break;
  }
  return true;
}

double correlation(const View& view) {
  return std::min(exposure_of(view.eyes[kLeft]).correlation,
                  exposure_of(view.eyes[kRight]).correlation);
}

// How far the detail of the reference's right image is off where the surfaces should be: noise of
// the images and errors of the disparities, but none of a motion.
double sigma_of_reference(const DirectPair& pair) {
  const View view = view_from({pair.camera, pair.reference, pair.reference.detail}, SE3{});
  return std::max(kMinSigma, exposure_of(view.eyes[kRight]).sigma);
}

// Where the coarsest images fit best; nothing when they fix no motion from any start.
std::optional<SE3> best_of(const DirectPair& coarsest, std::span<const SE3> starts) {
  std::optional<SE3> best;
  double best_score = 0.0;
  for (SE3 T_reference_camera : starts) {
    if (!converge(coarsest, T_reference_camera)) continue;
    const View view = view_from(coarsest, T_reference_camera);
    // A sliver of both images may look alike by chance.
    const double score = view.overlap() * correlation(view);
    if (score <= best_score) continue;
    best_score = score;
    best = T_reference_camera;
  }
  return best;
}

DirectAlignment judged(const DirectPair& finest, const SE3& T_reference_camera) {
  const View view = view_from(finest, T_reference_camera);
  const double sigma =
      std::max(exposure_of(view.eyes[kLeft]).sigma, exposure_of(view.eyes[kRight]).sigma);
  DirectAlignment result{.T_reference_camera = T_reference_camera,
                         .overlap = view.overlap(),
                         .correlation = correlation(view),
                         .residual_ratio = sigma / sigma_of_reference(finest)};
  const Eigen::LDLT<Matrix6d> factors(normal_equations(view).H);
  if (factors.rcond() > kMinCondition)
    result.covariance = kAlikePixels * factors.solve(Matrix6d::Identity());
  else
    result.covariance = kUnknown;
  return result;
}

cv::Mat1b detail_of(const cv::Mat1b& image) {
  const int side = 2 * surroundings_px(image) + 1;
  cv::Mat1f brightness, mean;
  image.convertTo(brightness, CV_32F);
  cv::boxFilter(brightness, mean, CV_32F, {side, side});
  cv::Mat1b detail;
  cv::Mat1f(2.0F * (brightness - mean) + 128.0F).convertTo(detail, CV_8U);
  return detail;
}

}  // namespace

DetailPair detail_of(const RectifiedPair& pair) {
  return {detail_of(pair.left.pixels), detail_of(pair.right.pixels)};
}

DirectAlignment align_directly(std::span<const DirectPair> coarse_to_fine,
                               std::span<const SE3> starts_T_reference_camera) {
  DirectAlignment unknown;
  unknown.covariance = kUnknown;
  auto T_reference_camera = best_of(coarse_to_fine.front(), starts_T_reference_camera);
  if (!T_reference_camera) return unknown;
  for (const DirectPair& pair : coarse_to_fine.subspan(1))
    if (!converge(pair, *T_reference_camera)) return unknown;
  return judged(coarse_to_fine.back(), *T_reference_camera);
}

}  // namespace stereovox
