// Fits the confidence model of census_sgm: fit_confidence FOLDER...
// Each folder holds left.png, right.png and disp_gt.png (KITTI's form). Prints the model for
// stereo/census_sgm.cpp and how reliable it is on the same pairs.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <opencv2/core.hpp>
#include <vector>

#include "stereovox/io/disparity_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/stereo/census_sgm.h"

namespace stereovox {
namespace {

constexpr int kSamplesPerPair = 40000;  // so that no pair outweighs the others
constexpr int kNewtonSteps = 30;
constexpr double kRidge = 1e-3;

using Row = Eigen::Vector4d;  // 1, ln ratio, -left-right difference, -ln(1 + variance)

struct Sample {
  Row features;
  double error_px;

  bool is_right() const { return std::abs(error_px) <= kRightWithin_px; }
};

void add_samples(const std::string& folder, std::vector<Sample>& samples) {
  RectifiedPair pair;
  pair.left = read_gray_image(folder + "/left.png").image;
  pair.right = read_gray_image(folder + "/right.png").image;
  const cv::Mat1f truth_px = read_disparity(folder + "/disp_gt.png").disparity_px;
  double largest_px = 0;
  cv::minMaxLoc(truth_px, nullptr, &largest_px);
  CensusSgmParams params;
  params.search.disparity_range_px = static_cast<int>(largest_px) + 1;
  const MatchFeatures f = match_features(pair, params, 1);
  const int step = std::max(1, static_cast<int>(truth_px.total()) / kSamplesPerPair);
  for (int i = 0; i < static_cast<int>(truth_px.total()); i += step) {
    const int v = i / truth_px.cols, u = i % truth_px.cols;
    if (!(truth_px(v, u) > 0.0F) || !std::isfinite(f.left_right_px(v, u))) continue;
    const Row row(1.0, std::min(f.log_ratio(v, u), kMaxLogRatio),
                  -std::min(f.left_right_px(v, u), kMaxLeftRight_px),
                  -std::log1p(std::min(f.variance_px2(v, u), kMaxVariance_px2)));
    samples.push_back({row, f.disparity_px(v, u) - truth_px(v, u)});
  }
}

double probability(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// Newton's method for the regularised likelihood.
Row fit(const std::vector<Sample>& samples) {
  Row weights = Row::Zero();
  for (int i = 0; i < kNewtonSteps; ++i) {
    Row gradient = -kRidge * weights;
    Eigen::Matrix4d hessian = kRidge * Eigen::Matrix4d::Identity();
    for (const Sample& s : samples) {
      const double p = probability(weights.dot(s.features));
      gradient += ((s.is_right() ? 1.0 : 0.0) - p) * s.features;
      hessian += p * (1.0 - p) * s.features * s.features.transpose();
    }
    weights += hessian.ldlt().solve(gradient);
  }
  return weights;
}

struct Bin {
  int count = 0, right = 0;
  double probability_sum = 0, squared_px2 = 0;
};

void print_bins(const std::vector<Sample>& samples, const Row& weights) {
  constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
  std::vector<Bin> bins(ConfidenceModel::kSigmaBins);
  for (const Sample& s : samples) {
    const double logit = weights.dot(s.features);
    const double place = (logit - ConfidenceModel::kMinLogit) / kSpan;
    const int i = static_cast<int>(place * ConfidenceModel::kSigmaBins);
    Bin& bin = bins[std::clamp(i, 0, ConfidenceModel::kSigmaBins - 1)];
    ++bin.count;
    bin.probability_sum += probability(logit);
    bin.right += s.is_right() ? 1 : 0;
    bin.squared_px2 += s.is_right() ? s.error_px * s.error_px : 0.0;
  }
  for (const Bin& bin : bins)
    std::cout << fmt::format(
        "sigma {:.3f} px, {:.2f} % of the pixels, predicted {:.3f}, right {:.3f}\n",
        std::sqrt(bin.squared_px2 / std::max(bin.right, 1)),
        100.0 * bin.count / static_cast<double>(samples.size()),
        bin.probability_sum / std::max(bin.count, 1),
        static_cast<double>(bin.right) / std::max(bin.count, 1));
}

void run(const std::vector<std::string>& folders) {
  std::vector<Sample> samples;
  for (const std::string& folder : folders) add_samples(folder, samples);
  const Row weights = fit(samples);
  std::cout << fmt::format(
      ".bias = {:.3f}, .ratio = {:.3f}, .left_right = {:.3f}, .variance = {:.3f}\n", weights[0],
      weights[1], weights[2], weights[3]);
  print_bins(samples, weights);
}

}  // namespace
}  // namespace stereovox

int main(int argc, char** argv) {
  try {
    stereovox::run({argv + 1, argv + argc});
    return argc > 1 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << "fit_confidence: error: " << error.what() << "\n";
    return 1;
  }
}
