// How well the detail of a reference fits the current images at one place of the camera, and which
// small motion would make it fit better: one step of direct alignment.
#pragma once

#include <algorithm>
#include <array>
#include <opencv2/core/types.hpp>
#include <vector>

#include "stereovox/core/se3.h"
#include "stereovox/odometry/direct_alignment.h"

namespace stereovox {

// What the detail in one of the current images shows.
struct EyeFit {
  int seen = 0;              // pixels of the reference that it shows
  double correlation = 0.0;  // normalised, with the reference
  double sigma = 0.0;        // of what the reference does not explain
};

struct DirectFit {
  int known = 0;  // pixels of the reference with a disparity
  EyeFit left = {}, right = {};
  // Normal equations of the twist x in T_reference_camera * exp(x): H * x = -g.
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();

  double overlap() const {
    return static_cast<double>(std::min(left.seen, right.seen)) / std::max(1, known);
  }
  double correlation() const { return std::min(left.correlation, right.correlation); }
  double sigma() const { return std::max(left.sigma, right.sigma); }
};

// Constants of the fast form and of the plain one.
namespace direct {
constexpr double kMinDepth_m = 0.05;
constexpr double kHuberSigmas = 1.345;
// Rounding alone leaves a third of a step.
constexpr double kMinSigma = 0.3;
// Rounding of sums leaves less than this of none.
constexpr double kNoVariance = 1e-6;
// The detail of no difference to the surroundings.
constexpr double kNoDetail = 128.0;
}  // namespace direct

// Half the side, in pixels, of the square that counts as the surroundings of a pixel.
int surroundings_px(const cv::Mat1b& image);

// Pixels whose surroundings the image shows; the detail of others depends on where it ends.
cv::Rect with_surroundings(const cv::Mat1b& image);

// Keeps its memory from place to place. The pair must outlive it.
class DirectFitter {
 public:
  explicit DirectFitter(const DirectPair& pair);

  DirectFit at(const SE3& T_reference_camera);

 private:
  // Numbers of the pixels in view, each kind on its own.
  struct Columns {
    std::array<std::vector<float>, 6> jacobian;  // of the current detail
    std::vector<float> reference, current;       // detail

    void resize(std::size_t size);
    void put(std::size_t n, float reference_detail, float current_detail,
             const Eigen::Vector3f& slope, const Eigen::Vector3f& p);
    void fill_up(std::size_t count);
  };
  struct Eye;

  static EyeFit add(Eye& eye, DirectFit& fit);

  const DirectPair pair_;
  std::vector<float> x_m_, y_m_, z_m_, detail_;  // of the known pixels of the reference
  Columns left_, right_;
};

}  // namespace stereovox
