// How probably a disparity is right, and how exact it then is. The model is a logistic regression
// on three features whose choice follows Hu and Mordohai (PAMI 2012); apps/fit_confidence fits the
// numbers on image pairs with truth.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

namespace stereovox {

// What a matcher found before it rejected anything; each image has the left image's size.
struct MatchFeatures {
  cv::Mat1f disparity_px;  // of the best candidate, whatever its sign
  // ln((second + 1) / (best + 1)), second the smallest cost of candidates that are not neighbours
  // of the best one; >= 0.
  cv::Mat1f log_ratio;
  // To the disparity of the left pixel that matches the same right pixel best; at least
  // kMaxLeftRight_px where the disparity reaches outside the right image.
  cv::Mat1f left_right_px;
  cv::Mat1f variance_px2;  // of the disparities in the 5 x 5 neighbourhood
};

inline constexpr float kMaxLogRatio = 2.0794415F;  // ln 8; larger features say no more
inline constexpr float kMaxLeftRight_px = 4.0F;
inline constexpr float kMaxVariance_px2 = 400.0F;
inline constexpr double kRightWithin_px = 2.0;  // what a right disparity is

struct ConfidenceModel {
  // ln(P / (1 - P)) = bias + ratio ln(second / best) - left_right |difference| - variance ln(1 +
  // var)
  double bias, ratio, left_right, variance;
  // rms error of the right disparities whose P lies in each tenth of the logit's span.
  static constexpr double kMinLogit = -4.0, kMaxLogit = 8.0;
  static constexpr int kSigmaBins = 12;
  std::array<double, kSigmaBins> sigma_px;
};

struct Credence {
  float confidence = 0;  // probability that the error is at most kRightWithin_px
  float sigma_px = 0;    // standard deviation of the error if it is
};

// The model as tables; a logit is rounded to one of 256 levels.
class CredenceTable {
 public:
  explicit CredenceTable(const ConfidenceModel& model);
  Credence of(float log_ratio, float left_right_px, float variance_px2) const;

 private:
  static constexpr int kLevels = 256;
  float ratio_, left_right_, bias_;
  std::array<float, kLevels> variance_term_ = {};
  std::array<Credence, kLevels> levels_ = {};
};

// variance_px2 from disparity_px; row by row, so that rows can be shared out to threads.
void fill_variance_row(MatchFeatures& features, int v);

}  // namespace stereovox
