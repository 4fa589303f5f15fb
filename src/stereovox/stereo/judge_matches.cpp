#include "stereovox/stereo/judge_matches.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/edge_medians.h"
#include "stereovox/stereo/row_kernels.h"
#include "stereovox/stereo/speckles.h"

namespace stereovox {
namespace {

// While the owner of a right pixel is sought, it is its cost, and below that its disparity, counted
// from the smallest. A right pixel that nobody matches has the largest of both.
constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

std::uint32_t owner_with(int cost, int disparity) {
  return static_cast<std::uint32_t>(cost << kDisparityBits | (disparity - kSmallestDisparity));
}

// See OwnedRow.
std::uint32_t pair_of_disparities(std::uint32_t owner, std::uint32_t beside) {
  return beside << kDisparityBits | static_cast<std::uint16_t>(owner);
}

// kLogRatioSteps ln(1 + cost).
const std::array<std::int16_t, 256>& log_of_raised() {
  static const std::array<std::int16_t, 256> table = [] {
    std::array<std::int16_t, 256> logs = {};
    for (std::size_t i = 0; i < logs.size(); ++i)
      logs[i] = static_cast<std::int16_t>(
          std::lround(kLogRatioSteps * std::log1p(static_cast<double>(i))));
    return logs;
  }();
  return table;
}

void fill_log_ratios(const WinnerRow& winners, std::uint8_t* out) {
  const std::int16_t* const log = log_of_raised().data();
  const std::uint8_t *const cost = winners.cost.data(), *const second = winners.second.data();
  for (std::size_t u = 0, width = winners.cost.size(); u < width; ++u)
    out[u] = static_cast<std::uint8_t>(std::clamp(log[second[u]] - log[cost[u]], 0, kMaxLogRatio));
}

bool is_recorded(const cv::Mat1b& valid, int v, int u) { return valid.empty() || valid(v, u) != 0; }

// Rejects pixels by setting their disparity to 0.
class Judge {
 public:
  Judge(const RectifiedPair& pair, const MatchFeatures& features, const CensusSearch& search,
        const ConfidenceModel& model)
      : pair_(pair),
        features_(features),
        table_(model, search.candidates()),
        min_log_ratio_(static_cast<int>(std::lround(
            -kLogRatioSteps * std::log1p(-kPercent * double(search.uniqueness_ratio_percent))))),
        max_left_right_(search.left_right_tolerance_px * kStepsPerPixel),
        min_level_(table_.first_level_of(search.min_confidence)),
        sure_level_(table_.first_level_of(search.island_confidence)) {}

  const CredenceTable& table() const { return table_; }

  // Writes the levels of confidence, the disparities that pass or 0, and 1 where islands may stay.
  void judge_row(int v, std::uint8_t* level, std::int16_t* passed, std::uint8_t* is_sure) const {
    table_.fill_level_row(features_, v, level);
    const cv::Mat1b& left = pair_.left.pixels;
    const JudgedRow row = {.disparity = features_.disparity[v],
                           .gray_above = left[std::max(v - 1, 0)],
                           .gray = left[v],
                           .gray_below = left[std::min(v + 1, left.rows - 1)],
                           .log_ratio = features_.log_ratio[v],
                           .left_right = features_.left_right[v],
                           .level = level,
                           .min_log_ratio = min_log_ratio_,
                           .max_left_right = max_left_right_,
                           .min_level = min_level_,
                           .sure_level = sure_level_};
    fastest_row_kernels().judge(row, features_.disparity.cols, passed, is_sure);
    keep_seen(v, passed);
  }

  // Rejects what does not join two recorded pixels.
  void keep_seen(int v, std::int16_t* passed) const {
    fastest_row_kernels().keep_seen(features_.disparity.cols, passed);
    if (!pair_.valid_left.empty() || !pair_.valid_right.empty()) keep_recorded(v, passed);
  }

 private:
  static constexpr double kPercent = 0.01;

  void keep_recorded(int v, std::int16_t* passed) const {
    for (int u = 0; u < features_.disparity.cols; ++u) {
      const int there = u - (passed[u] + kStepsPerPixel / 2) / kStepsPerPixel;
      if (!is_recorded(pair_.valid_left, v, u) || !is_recorded(pair_.valid_right, v, there))
        passed[u] = 0;
    }
  }

  const RectifiedPair& pair_;
  const MatchFeatures& features_;
  const CredenceTable table_;
  const int min_log_ratio_, max_left_right_, min_level_, sure_level_;
};

void write_row(const std::int16_t* passed, const std::uint8_t* level, const CredenceTable& table,
               int v, DisparityImage& out) {
  float* const disparity_px = out.disparity_px[v];
  float *const sigma_px = out.sigma_px[v], *const confidence = out.confidence[v];
  for (int u = 0; u < out.width(); ++u) {
    const Credence credence = passed[u] != 0 ? table.at(level[u]) : Credence{};
    disparity_px[u] = static_cast<float>(passed[u]) * (1.0F / kStepsPerPixel);
    sigma_px[u] = credence.sigma_px;
    confidence[u] = credence.confidence;
  }
}

}  // namespace

MatchFeatures features_of_size(cv::Size size) {
  return {cv::Mat1s(size), cv::Mat1b(size), cv::Mat1b(size), cv::Mat1b(size)};
}

FeatureRows::FeatureRows(int width_px, int min_disparity_px, int max_disparity_px)
    : width_px_(width_px),
      max_disparity_px_(max_disparity_px),
      before_(std::max(0, max_disparity_px) + 1),
      after_(std::max(0, -min_disparity_px) + 1),
      owner_(before_ + width_px + after_) {}

void FeatureRows::fill(const WinnerRow& winners, int v, MatchFeatures& features) {
  fastest_row_kernels().disparities({.candidate = winners.candidate.data(),
                                     .before = winners.local_before.data(),
                                     .here = winners.local.data(),
                                     .after = winners.local_after.data()},
                                    width_px_, max_disparity_px_, features.disparity[v]);
  find_owners(winners, features.disparity[v]);
  fastest_row_kernels().left_right({.candidate = winners.candidate.data(),
                                    .disparity = features.disparity[v],
                                    .owners = first_owner(),
                                    .max_disparity_px = max_disparity_px_,
                                    .max_difference = kMaxLeftRight},
                                   width_px_, features.left_right[v]);
  fill_log_ratios(winners, features.log_ratio[v]);
  std::ranges::copy(winners.local, features.local_cost[v]);
}

// Right pixels beyond the image have no owner, nor have those that nobody matches best.
void FeatureRows::find_owners(const WinnerRow& winners, const std::int16_t* disparity) {
  std::ranges::fill(owner_, kNobody);
  std::uint32_t* const owner = first_owner();
  const std::uint8_t *const candidate = winners.candidate.data(), *const cost = winners.cost.data();
  for (int u = 0, width = width_px_; u < width; ++u) {
    std::uint32_t& best = owner[u + candidate[u]];
    best = std::min(best, owner_with(cost[u], disparity[u]));
  }
  std::fill_n(owner_.begin(), before_, kNobody);
  std::fill_n(owner_.rbegin(), after_, kNobody);
  for (std::size_t i = 0; i + 1 < owner_.size(); ++i)
    owner_[i] = pair_of_disparities(owner_[i], owner_[i + 1]);
}

DisparityImage judge_matches(const RectifiedPair& pair, const MatchFeatures& features,
                             const CensusSearch& search, const ConfidenceModel& model,
                             int threads) {
  const cv::Size size = features.disparity.size();
  const Judge judge(pair, features, search, model);
  cv::Mat1b level(size), is_sure(size);
  cv::Mat1s passed(size);
  parallel_for(0, size.height, threads,
               [&](int v) { judge.judge_row(v, level[v], passed[v], is_sure[v]); });
  remove_speckles(passed, is_sure, search.speckle_size_px,
                  search.speckle_range_px * kStepsPerPixel);
  settle_edges(pair.left.pixels, search.edge_likeness_gray, passed, threads);
  DisparityImage out{cv::Mat1f(size), cv::Mat1f(size), cv::Mat1f(size)};
  parallel_for(0, size.height, threads, [&](int v) {
    judge.keep_seen(v, passed[v]);
    write_row(passed[v], level[v], judge.table(), v, out);
  });
  return out;
}

}  // namespace stereovox
