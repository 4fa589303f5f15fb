#include "stereovox/odometry/direct_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "stereovox/odometry/direct_fit.h"

namespace stereovox {
namespace {

constexpr int kMaxDirectIterations = 30;
// Steps below 10 micrometres and microradians change nothing.
constexpr double kConverged = 1e-5;
constexpr int kMinPixels = 50;
constexpr double kMinCondition = 1e-12;
const Matrix6d kUnknown = Matrix6d::Constant(std::numeric_limits<double>::infinity());
// Errors of the surfaces are alike over a patch of pixels, so that many count as one measurement.
constexpr double kAlikePixels = 100.0;

// False when the detail does not fix the motion.
bool converge(DirectFitter& fitter, SE3& T_reference_camera) {
  for (int i = 0; i < kMaxDirectIterations; ++i) {
    const DirectFit fit = fitter.at(T_reference_camera);
    if (std::min(fit.left.seen, fit.right.seen) < kMinPixels) return false;
    const Eigen::LDLT<Matrix6d> factors(fit.H);
    if (!(factors.rcond() > kMinCondition)) return false;
    const Vector6d step = factors.solve(-fit.g);
    T_reference_camera = T_reference_camera * exp(step);
    if (step.norm() < kConverged) break;
  }
  return true;
}

// How far the detail of the reference's right image is off where the surfaces should be: noise of
// the images and errors of the disparities, but none of a motion.
double sigma_of_reference(const DirectPair& pair) {
  DirectFitter fitter({pair.camera, pair.reference, pair.reference.detail});
  return std::max(direct::kMinSigma, fitter.at(SE3{}).right.sigma);
}

// Where the coarsest images fit best; nothing when they fix no motion from any start.
std::optional<SE3> best_of(const DirectPair& coarsest, std::span<const SE3> starts) {
  DirectFitter fitter(coarsest);
  std::optional<SE3> best;
  double best_score = 0.0;
  for (SE3 T_reference_camera : starts) {
    if (!converge(fitter, T_reference_camera)) continue;
    const DirectFit fit = fitter.at(T_reference_camera);
    // A sliver of both images may look alike by chance.
    const double score = fit.overlap() * fit.correlation();
    if (score <= best_score) continue;
    best_score = score;
    best = T_reference_camera;
  }
  return best;
}

DirectAlignment judged(const DirectFit& fit, double sigma_of_reference,
                       const SE3& T_reference_camera) {
  DirectAlignment result{.T_reference_camera = T_reference_camera,
                         .overlap = fit.overlap(),
                         .correlation = fit.correlation(),
                         .residual_ratio = fit.sigma() / sigma_of_reference};
  const Eigen::LDLT<Matrix6d> factors(fit.H);
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
  cv::Mat1f(2.0F * (brightness - mean) + direct::kNoDetail).convertTo(detail, CV_8U);
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
  for (const DirectPair& pair : coarse_to_fine.subspan(1)) {
    DirectFitter fitter(pair);
    if (!converge(fitter, *T_reference_camera)) return unknown;
  }
  const DirectPair& finest = coarse_to_fine.back();
  return judged(DirectFitter(finest).at(*T_reference_camera), sigma_of_reference(finest),
                *T_reference_camera);
}

}  // namespace stereovox
