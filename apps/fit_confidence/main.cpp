// Fits the confidence model of a census matcher: fit_confidence MATCHER FOLDER...; MATCHER may be a
// support of adaptive_window, too (nine_windows).
// Each folder holds left.png, right.png and disp_gt.png (KITTI's form) or disp_gt.pfm. Noise that
// shows no scene at all is learned from, too. Prints the model for stereo/<MATCHER>.cpp and how
// reliable it is on the same pairs.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/io/disparity_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/stereo/adaptive_window.h"
#include "stereovox/stereo/census_sgm.h"

namespace stereovox {
namespace {

constexpr int kSamplesPerPair = 40000;  // so that no pair outweighs the others
constexpr int kNewtonSteps = 30;
constexpr double kRidge = 1e-3;
// The pairs are rectified better than cameras of robots are: this much their errors lack.
constexpr double kRectification_px = 0.1;

constexpr int kFeatures = 6;
using Row = Eigen::Matrix<double, kFeatures, 1>;  // 1, then as in ConfidenceModel, with its signs
using Square = Eigen::Matrix<double, kFeatures, kFeatures>;

struct Sample {
  Row features;
  double error_px;
  bool passes;  // all other checks of the matcher

  bool is_right() const { return std::abs(error_px) <= kRightWithin_px; }
};

Row row_of(const PixelFeatures& f, int candidates) {
  Row row;
  row << 1.0, f.log_ratio, -f.left_right_px, -f.log_variance, -f.local_cost,
      log_of_candidates(candidates);
  return row;
}

struct Found {
  MatchFeatures features;
  DisparityImage passed;  // what is left of them, with its edges settled
};

// What the matcher finds among this number of disparities.
using FindMatches = std::function<Found(const RectifiedPair&, int disparity_range_px)>;

template <class Params>
FindMatches finder_with(const Params& params) {
  return [params](const RectifiedPair& pair, int disparity_range_px) {
    Params wide = params;
    wide.search.disparity_range_px = disparity_range_px;
    wide.search.min_confidence = 0;
    return Found{match_features(pair, wide, 1), match(pair, wide, 1)};
  };
}

// The name of a matcher, or of a support of adaptive_window.
FindMatches finder_of(const std::string& matcher) {
  if (matcher == CensusSgmParams::kName) return finder_with(CensusSgmParams{});
  if (matcher == AdaptiveWindowParams::kName) return finder_with(AdaptiveWindowParams{});
  const auto supports = names_of(WindowSupport{});
  const auto named = std::ranges::find(supports, matcher);
  if (named == supports.end()) throw UsageError(matcher + ": is no census matcher");
  AdaptiveWindowParams params;
  params.support = static_cast<WindowSupport>(named - supports.begin());
  return finder_with(params);
}

// Where there is no true disparity there is no sample; what is infinite nothing can match.
void add_samples(const FindMatches& find, const RectifiedPair& pair, const cv::Mat1f& truth_px,
                 int disparity_range_px, int count, std::vector<Sample>& samples) {
  const auto [f, passed] = find(pair, disparity_range_px);
  CensusSearch search;
  search.disparity_range_px = disparity_range_px;
  cv::Mat1f variance_px2(truth_px.size());
  for (int v = 0; v < truth_px.rows; ++v) fill_variance_row(f.disparity, v, variance_px2[v]);
  const int step = std::max(1, static_cast<int>(truth_px.total()) / count);
  for (int i = 0; i < static_cast<int>(truth_px.total()); i += step) {
    const int v = i / truth_px.cols, u = i % truth_px.cols;
    const bool passes = passed.disparity_px(v, u) > 0.0F;
    const double raw_px = static_cast<double>(f.disparity(v, u)) / kStepsPerPixel;
    const double found_px = passes ? passed.disparity_px(v, u) : raw_px;
    if (!(truth_px(v, u) > 0.0F) || found_px > u) continue;
    samples.push_back({row_of(features_at(f, v, u, variance_px2(v, u)), search.candidates()),
                       found_px - truth_px(v, u), passes});
  }
}

void add_pair(const FindMatches& find, const std::string& folder, std::vector<Sample>& samples) {
  RectifiedPair pair;
  pair.left = read_gray_image(folder + "/left.png").image;
  pair.right = read_gray_image(folder + "/right.png").image;
  const std::string truth = folder + "/disp_gt.png";
  const cv::Mat1f truth_px =
      read_disparity(std::filesystem::exists(truth) ? truth : folder + "/disp_gt.pfm").disparity_px;
  double largest_px = 0;
  cv::minMaxLoc(truth_px, nullptr, &largest_px);
  // The more disparities are searched, the better is the second best of them.
  for (const int range_px : {static_cast<int>(largest_px) + 1, kMaxCandidates})
    add_samples(find, pair, truth_px, range_px, kSamplesPerPair, samples);
}

// Independent noise of `levels` grey values in both images, as fine as pixels or coarser.
void add_noise(const FindMatches& find, int levels, double blur_px, std::vector<Sample>& samples) {
  constexpr int kSamplesOfNoise = 2000;
  const cv::Size size(320, 240);
  cv::RNG random(static_cast<std::uint64_t>(levels));
  RectifiedPair pair;
  for (GrayImage* const image : {&pair.left, &pair.right}) {
    image->pixels.create(size);
    random.fill(image->pixels, cv::RNG::UNIFORM, 0, levels);
    if (blur_px > 0) cv::GaussianBlur(image->pixels, image->pixels, {0, 0}, blur_px);
  }
  const cv::Mat1f nothing(size, std::numeric_limits<float>::infinity());
  add_samples(find, pair, nothing, CensusSearch{}.disparity_range_px, kSamplesOfNoise, samples);
}

double probability(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// Newton's method for the regularised likelihood.
Row fit(const std::vector<Sample>& samples) {
  Row weights = Row::Zero();
  for (int i = 0; i < kNewtonSteps; ++i) {
    Row gradient = -kRidge * weights;
    Square hessian = kRidge * Square::Identity();
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
  int count = 0, right = 0;  // of those that pass
  int all_right = 0;         // whether they pass or not: this is on the safe side
  double squared_px2 = 0;    // sum of their errors
};

// Of the pairs alone: noise says nothing about how often scenes are right.
std::vector<Bin> bins_of(std::span<const Sample> samples, const Row& weights) {
  constexpr double kSpan = ConfidenceModel::kMaxLogit - ConfidenceModel::kMinLogit;
  std::vector<Bin> bins(ConfidenceModel::kBins);
  for (const Sample& s : samples) {
    const double place = (weights.dot(s.features) - ConfidenceModel::kMinLogit) / kSpan;
    const int i = static_cast<int>(place * ConfidenceModel::kBins);
    Bin& bin = bins[static_cast<std::size_t>(std::clamp(i, 0, ConfidenceModel::kBins - 1))];
    bin.count += s.passes ? 1 : 0;
    bin.right += s.passes && s.is_right() ? 1 : 0;
    bin.all_right += s.is_right() ? 1 : 0;
    bin.squared_px2 += s.is_right() ? s.error_px * s.error_px : 0.0;
  }
  return bins;
}

double right_share(const Bin& bin) {
  return static_cast<double>(bin.right) / std::max(bin.count, 1);
}

// Who is surer is not less often right: neighbours that contradict this become one bin, as do those
// without samples.
std::vector<Bin> pooled(const std::vector<Bin>& bins) {
  struct Pool {
    Bin sum;
    std::size_t bins;
  };
  std::vector<Pool> pools;
  for (const Bin& bin : bins) {
    pools.push_back({bin, 1});
    while (pools.size() > 1 && right_share(pools.back().sum) < right_share(pools.rbegin()[1].sum)) {
      const Pool last = pools.back();
      pools.pop_back();
      Bin& sum = pools.back().sum;
      sum = {sum.count + last.sum.count, sum.right + last.sum.right,
             sum.all_right + last.sum.all_right, sum.squared_px2 + last.sum.squared_px2};
      pools.back().bins += last.bins;
    }
  }
  std::vector<Bin> out;
  for (const Pool& pool : pools) out.insert(out.end(), pool.bins, pool.sum);
  return out;
}

void print(const std::vector<Bin>& bins, const Row& w) {
  std::cout << fmt::format(
      ".bias = {:.3f}, .ratio = {:.3f}, .left_right = {:.3f}, .variance = {:.3f}, .local = "
      "{:.4f}, .candidates = {:.3f}\n",
      w[0], w[1], w[2], w[3], w[4], w[5]);
  for (const Bin& bin : bins)
    std::cout << fmt::format(
        "right {:.3f}, sigma {:.2f} px, {} samples\n", right_share(bin),
        std::hypot(std::sqrt(bin.squared_px2 / std::max(bin.all_right, 1)), kRectification_px),
        bin.count);
}

void run(const std::string& matcher, const std::vector<std::string>& folders) {
  const FindMatches find = finder_of(matcher);
  std::vector<Sample> samples;
  for (const std::string& folder : folders) add_pair(find, folder, samples);
  const std::size_t of_pairs = samples.size();
  for (const int levels : {2, 4, 8, 32, 256})
    for (const double blur_px : {0.0, 0.8, 1.5}) add_noise(find, levels, blur_px, samples);
  const Row weights = fit(samples);
  print(pooled(bins_of(std::span(samples).first(of_pairs), weights)), weights);
}

}  // namespace
}  // namespace stereovox

int main(int argc, char** argv) {
  try {
    if (argc < 3) return 2;
    stereovox::run(argv[1], {argv + 2, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "fit_confidence: error: " << error.what() << "\n";
    return 1;
  }
}
