#include "stereovox/odometry/direct_fit_reference.h"

#include <cmath>
#include <optional>
#include <vector>

#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {
namespace {

using namespace direct;

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

EyeFit eye_fit(const std::vector<SeenPixel>& pixels) {
  const Exposure exposure = exposure_of(pixels);
  return {static_cast<int>(pixels.size()), exposure.correlation, exposure.sigma};
}

}  // namespace

DirectFit direct_fit_reference(const DirectPair& pair, const SE3& T_reference_camera) {
  const View view = view_from(pair, T_reference_camera);
  const NormalEquations equations = normal_equations(view);
  return {view.known, eye_fit(view.eyes[kLeft]), eye_fit(view.eyes[kRight]), equations.H,
          equations.g};
}

}  // namespace stereovox
