#include "stereovox/stereo/judge_matches.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "stereovox/core/parallel.h"
#include "stereovox/stereo/speckles.h"

namespace stereovox {
namespace {

// ln(1 + cost), for costs up to 255.
const std::array<float, 256>& log_of_raised() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> logs = {};
    for (std::size_t i = 0; i < logs.size(); ++i)
      logs[i] = static_cast<float>(std::log1p(static_cast<double>(i)));
    return logs;
  }();
  return table;
}

void fill_disparities(const WinnerRow& winners, int max_disparity_px, float* disparity_px) {
  for (std::size_t u = 0; u < winners.local.size(); ++u) {
    const int cost = winners.local[u], before = winners.local_before[u];
    const int after = winners.local_after[u], bend = before + after - 2 * cost;
    const bool has_vertex = before != kNoLocalCost && after != kNoLocalCost &&
                            std::min(before, after) >= cost && bend > 0;
    const float shift =
        static_cast<float>(before - after) / static_cast<float>(2 * std::max(bend, 1));
    disparity_px[u] =
        static_cast<float>(max_disparity_px - winners.candidate[u]) - (has_vertex ? shift : 0.0F);
  }
}

// Who matches each right pixel best: its cost, and below that its column; the first of equals.
class RightOwners {
 public:
  RightOwners(const WinnerRow& winners, int max_disparity_px)
      : winners_(winners),
        max_disparity_px_(max_disparity_px),
        owner_(winners.cost.size(), kNobody) {
    for (int u = 0; u < width(); ++u)
      if (const int there = right_column(u); is_inside(there))
        owner_[there] =
            std::min(owner_[there], winners.cost[u] << kColumnBits | static_cast<std::uint32_t>(u));
  }

  int width() const { return static_cast<int>(owner_.size()); }
  int right_column(int u) const { return u - max_disparity_px_ + winners_.candidate[u]; }
  bool is_inside(int column) const { return column >= 0 && column < width(); }
  bool has_owner(int column) const { return is_inside(column) && owner_[column] != kNobody; }
  int owner(int column) const { return static_cast<int>(owner_[column] & kColumnMask); }

 private:
  static constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();
  static constexpr int kColumnBits = 16;
  static constexpr std::uint32_t kColumnMask = (1U << kColumnBits) - 1;

  const WinnerRow& winners_;
  const int max_disparity_px_;
  std::vector<std::uint32_t> owner_;
};

// A sub-pixel disparity ends between two right pixels; one of them must agree.
void fill_left_right(const RightOwners& owners, const float* disparity_px, float* left_right_px) {
  for (int u = 0; u < owners.width(); ++u) {
    const int there = owners.right_column(u);
    left_right_px[u] = std::numeric_limits<float>::infinity();
    if (!owners.is_inside(there)) continue;
    const bool ends_before = disparity_px[u] > static_cast<float>(u - there);
    for (const int column : {there, ends_before ? there - 1 : there + 1}) {
      if (!owners.has_owner(column)) continue;
      const float difference_px = std::abs(disparity_px[u] - disparity_px[owners.owner(column)]);
      left_right_px[u] = std::min(left_right_px[u], std::min(difference_px, kMaxLeftRight_px));
    }
  }
}

bool is_recorded(const cv::Mat1b& valid, int v, int u) { return valid.empty() || valid(v, u) != 0; }

bool joins_recorded_pixels(const RectifiedPair& pair, int v, int u, float disparity_px) {
  const int there = u - static_cast<int>(std::lround(disparity_px));
  return there >= 0 && there < pair.right.width() && is_recorded(pair.valid_left, v, u) &&
         is_recorded(pair.valid_right, v, there);
}

class Judge {
 public:
  Judge(const RectifiedPair& pair, const MatchFeatures& features, const CensusSearch& search,
        const ConfidenceModel& model)
      : pair_(pair),
        features_(features),
        table_(model),
        min_log_ratio_(static_cast<float>(
            -std::log1p(-kPercent * static_cast<double>(search.uniqueness_ratio_percent)))),
        max_left_right_px_(static_cast<float>(search.left_right_tolerance_px)),
        min_confidence_(static_cast<float>(search.min_confidence)) {}

  void judge_row(int v, DisparityImage& out) const {
    const float* const disparity_px = features_.disparity_px[v];
    const float* const log_ratio = features_.log_ratio[v];
    const float* const left_right_px = features_.left_right_px[v];
    const float* const variance_px2 = features_.variance_px2[v];
    for (int u = 0; u < out.width(); ++u) {
      if (!(disparity_px[u] > 0.0F) || log_ratio[u] < min_log_ratio_ ||
          left_right_px[u] > max_left_right_px_)
        continue;
      const Credence credence = table_.of(log_ratio[u], left_right_px[u], variance_px2[u]);
      if (credence.confidence < min_confidence_ ||
          !joins_recorded_pixels(pair_, v, u, disparity_px[u]))
        continue;
      out.disparity_px(v, u) = disparity_px[u];
      out.sigma_px(v, u) = credence.sigma_px;
      out.confidence(v, u) = credence.confidence;
    }
  }

 private:
  static constexpr double kPercent = 0.01;

  const RectifiedPair& pair_;
  const MatchFeatures& features_;
  const CredenceTable table_;
  const float min_log_ratio_, max_left_right_px_, min_confidence_;
};

void forget_removed(DisparityImage& image, int v) {
  for (int u = 0; u < image.width(); ++u)
    if (image.disparity_px(v, u) == 0.0F) image.sigma_px(v, u) = image.confidence(v, u) = 0.0F;
}

}  // namespace

MatchFeatures features_of_size(cv::Size size) {
  return {cv::Mat1f(size), cv::Mat1f(size), cv::Mat1f(size), cv::Mat1f(size)};
}

void fill_feature_row(const WinnerRow& winners, int max_disparity_px, int v,
                      MatchFeatures& features) {
  fill_disparities(winners, max_disparity_px, features.disparity_px[v]);
  fill_left_right(RightOwners(winners, max_disparity_px), features.disparity_px[v],
                  features.left_right_px[v]);
  const std::array<float, 256>& log_raised = log_of_raised();
  float* const log_ratio = features.log_ratio[v];
  for (std::size_t u = 0; u < winners.cost.size(); ++u)
    log_ratio[u] = std::max(0.0F, log_raised[winners.second[u]] - log_raised[winners.cost[u]]);
}

DisparityImage judge_matches(const RectifiedPair& pair, const MatchFeatures& features,
                             const CensusSearch& search, const ConfidenceModel& model,
                             int threads) {
  const cv::Size size = features.disparity_px.size();
  DisparityImage out{cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F), cv::Mat1f(size, 0.0F)};
  const Judge judge(pair, features, search, model);
  parallel_for(0, size.height, threads, [&](int v) { judge.judge_row(v, out); });
  remove_speckles(out.disparity_px, search.speckle_size_px,
                  static_cast<float>(search.speckle_range_px));
  parallel_for(0, size.height, threads, [&](int v) { forget_removed(out, v); });
  return out;
}

}  // namespace stereovox
