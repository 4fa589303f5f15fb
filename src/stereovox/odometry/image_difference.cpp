#include "stereovox/odometry/image_difference.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "stereovox/odometry/motion_estimate.h"

namespace stereovox {
namespace {

constexpr double kNearestCompared_m = 0.05;
constexpr int kMinComparedPixels = 50;
// Rounding alone leaves a third of a step.
constexpr double kMinSigma = 0.3;
// Patterns as fine as the pixels differ between them by more than a motion changes: they are
// blurred.
constexpr int kBlur_px = 5;
// Keeps the sums below of one size.
constexpr double kBrightnessScale = 1.0 / 64.0;

// What the current brightness is explained by: that of the reference and a smooth surface.
constexpr int kTerms = 7;
using Terms = Eigen::Matrix<double, kTerms, 1>;

Terms terms_of(const cv::Mat1b& reference, int u, int v) {
  const double x = 2.0 * u / reference.cols - 1.0, y = 2.0 * v / reference.rows - 1.0;
  Terms terms;
  terms << kBrightnessScale * reference(v, u), 1.0, x, y, x * x, x * y, y * y;
  return terms;
}

cv::Mat1b blurred(const GrayImage& image) {
  cv::Mat1b result;
  cv::GaussianBlur(image.pixels, result, {kBlur_px, kBlur_px}, 0.0);
  return result;
}

// Between the pixels; nothing outside.
std::optional<double> brightness_at(const cv::Mat1b& image, double x, double y) {
  if (!(x >= 0.0 && y >= 0.0 && x < image.cols - 1 && y < image.rows - 1)) return std::nullopt;
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const double a = x - u, b = y - v;
  const std::uint8_t *row = image[v] + u, *next = image[v + 1] + u;
  return (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * next[0] + a * next[1]);
}

// The current brightness of a point in the left image and in the right.
struct Seen {
  std::optional<double> left, right;
};

// What the current pair shows, blurred.
class CurrentView {
 public:
  CurrentView(const RectifiedCamera& camera, const RectifiedPair& pair)
      : camera_(camera), left_(blurred(pair.left)), right_(blurred(pair.right)) {}

  Seen at(const Eigen::Vector3d& p_camera) const {
    if (p_camera.z() < kNearestCompared_m) return {};
    const Eigen::Vector3d pixels = project_stereo(camera_, p_camera);
    return {brightness_at(left_, pixels[0], pixels[1]),
            brightness_at(right_, pixels[2], pixels[1])};
  }

 private:
  const RectifiedCamera& camera_;
  cv::Mat1b left_, right_;
};

// What is left of the brightness seen from two places when each is explained as well as can be.
class TwoFits {
 public:
  void add(const Terms& terms, double seen_from_a, double seen_from_b) {
    const Eigen::Vector2d seen = kBrightnessScale * Eigen::Vector2d(seen_from_a, seen_from_b);
    H_ += terms * terms.transpose();
    g_ += terms * seen.transpose();
    squares_ += seen.cwiseAbs2();
    ++count_;
  }
  double log_ratio() const {
    if (count_ < kMinComparedPixels) return 0.0;
    const Eigen::Matrix<double, kTerms, 2> explained = Eigen::LDLT<decltype(H_)>(H_).solve(g_);
    const Eigen::Vector2d left = squares_ - explained.cwiseProduct(g_).colwise().sum().transpose();
    return std::log(sigma(left[0]) / sigma(left[1]));
  }

 private:
  double sigma(double squares) const {
    return std::max(kMinSigma, std::sqrt(std::max(0.0, squares) / count_) / kBrightnessScale);
  }

  Eigen::Matrix<double, kTerms, kTerms> H_ = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Eigen::Matrix<double, kTerms, 2> g_ = Eigen::Matrix<double, kTerms, 2>::Zero();
  Eigen::Vector2d squares_ = Eigen::Vector2d::Zero();
  int count_ = 0;
};

// Of one size, mean of both eyes.
double log_ratio(const ViewPair& pair, const SE3& T_a_reference, const SE3& T_b_reference) {
  TwoFits left, right;
  const cv::Mat1b reference = blurred(pair.reference.pair.left);
  const CurrentView current(pair.camera, pair.current.pair);
  const cv::Mat1f& disparities_px = pair.reference.disparity.disparity_px;
  for (int v = 0; v < disparities_px.rows; ++v)
    for (int u = 0; u < disparities_px.cols; ++u) {
      const float disparity_px = disparities_px(v, u);
      if (disparity_px <= 0.0F) continue;
      const Eigen::Vector3d p = triangulate(pair.camera, u, v, disparity_px);
      const Seen a = current.at(T_a_reference * p), b = current.at(T_b_reference * p);
      const Terms terms = terms_of(reference, u, v);
      if (a.left && b.left) left.add(terms, *a.left, *b.left);
      if (a.right && b.right) right.add(terms, *a.right, *b.right);
    }
  return (left.log_ratio() + right.log_ratio()) / 2.0;
}

}  // namespace

double difference_ratio(std::span<const ViewPair> views, const SE3& T_reference_a,
                        const SE3& T_reference_b) {
  double sum = 0.0;
  for (const ViewPair& pair : views)
    sum += log_ratio(pair, inverse(T_reference_a), inverse(T_reference_b));
  return std::exp(sum / static_cast<double>(std::max<std::size_t>(1, views.size())));
}

}  // namespace stereovox
