// How probably a disparity is right, and how exact it then is. The model is a logistic regression
// on four features of a pixel, three of them after Hu and Mordohai (PAMI 2012), and the number of
// disparities searched; apps/fit_confidence fits the numbers on image pairs with truth.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "stereovox/stereo/row_kernels.h"

namespace stereovox {

// What a matcher found before it rejected anything; each image has the left image's size.
struct MatchFeatures {
  cv::Mat1s disparity;  // of the best candidate, in steps, whatever its sign
  // kLogRatioSteps ln((second + 1) / (best + 1)), second the smallest cost of candidates that are
  // not neighbours of the best one; 0 to kMaxLogRatio.
  cv::Mat1b log_ratio;
  // To the disparity of the left pixel that matches the same right pixel best, in steps, at most
  // kMaxLeftRight.
  cv::Mat1b left_right;
  cv::Mat1b local_cost;  // of the best candidate, without what the paths say
};

inline constexpr int kLogRatioSteps = 64;
inline constexpr int kMaxLogRatio = 133;  // ln 8; larger features say no more
inline constexpr int kMaxLeftRight = 4 * kStepsPerPixel;
inline constexpr double kRightWithin_px = 2.0;  // what a right disparity is

// The features of one pixel in the units of the model.
struct PixelFeatures {
  float log_ratio, left_right_px, log_variance, local_cost;
};

struct ConfidenceModel {
  // logit = bias + ratio ln(second / best) - left_right |difference| -
  //         variance log2(1 + variance) - local local_cost + candidates log2(searched / 64)
  double bias, ratio, left_right, variance, local, candidates;
  // Of the disparities whose logit lies in each equal part of this span: the share that is right,
  // and the rms error of those.
  static constexpr double kMinLogit = -4.0, kMaxLogit = 8.0;
  static constexpr int kBins = 12;
  std::array<double, kBins> right, sigma_px;
};

// log2(candidates / 64): the more are searched, the better is the second best of them.
double log_of_candidates(int candidates);

// log2(1 + variance) by straight lines between powers of two, as the bits of a float have it.
float log_of_raised_variance(float variance_px2);

// Of the disparities in the 5 x 5 neighbourhood of each pixel of row v.
void fill_variance_row(const cv::Mat1s& disparity, int v, float* variance_px2);

PixelFeatures features_at(const MatchFeatures& features, int v, int u, float variance_px2);

struct Credence {
  float confidence = 0;  // probability that the error is at most kRightWithin_px
  float sigma_px = 0;    // standard deviation of the error if it is
};

// The model as a table: a logit is rounded to one of kLevels levels from kMinLogit to kMaxLogit.
// Between the middles of the bins confidence and sigma follow straight lines.
class CredenceTable {
 public:
  static constexpr int kLevels = 255;

  CredenceTable(const ConfidenceModel& model, int candidates);
  Credence at(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  int first_level_of(double confidence) const;  // kLevels where none is as sure

  // The level of each pixel of row v of `features`.
  void fill_level_row(const MatchFeatures& features, int v, std::uint8_t* level) const;

 private:
  // Weights of the features as they are stored, in levels.
  float bias_, log_ratio_, left_right_, variance_, local_cost_;
  std::array<Credence, kLevels> levels_ = {};
};

}  // namespace stereovox
