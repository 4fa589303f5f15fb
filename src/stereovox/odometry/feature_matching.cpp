#include "stereovox/odometry/feature_matching.h"

#include <cassert>

namespace stereovox {
namespace {

constexpr int kNone = -1;

struct Best {
  int index = kNone;
  double score;

  void offer(int candidate, double candidate_score) {
    if (candidate_score > score) {
      index = candidate;
      score = candidate_score;
    }
  }
};

bool is_within(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double half_window_px) {
  return (a - b).cwiseAbs().maxCoeff() <= half_window_px;
}

}  // namespace

std::vector<FeatureMatch> match_features(const FeatureSet& reference,
                                         std::span<const Eigen::Vector2d> expected_px,
                                         const FeatureSet& current, double half_window_px,
                                         double min_score) {
  assert(expected_px.size() == reference.features.size());
  std::vector<Best> best_current(reference.features.size(), Best{kNone, min_score});
  std::vector<Best> best_reference(current.features.size(), Best{kNone, min_score});
  for (std::size_t i = 0; i < reference.features.size(); ++i)
    for (std::size_t j = 0; j < current.features.size(); ++j) {
      if (!is_within(expected_px[i], current.features[j].pixel, half_window_px)) continue;
      const double score = correlation(reference.descriptors[i], current.descriptors[j]);
      best_current[i].offer(static_cast<int>(j), score);
      best_reference[j].offer(static_cast<int>(i), score);
    }

  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < best_current.size(); ++i) {
    const int j = best_current[i].index;
    const int reference_index = static_cast<int>(i);
    if (j != kNone && best_reference[static_cast<std::size_t>(j)].index == reference_index)
      matches.push_back({reference_index, j, best_current[i].score});
  }
  return matches;
}

}  // namespace stereovox
