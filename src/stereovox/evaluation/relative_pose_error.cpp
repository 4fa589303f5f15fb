#include "stereovox/evaluation/relative_pose_error.h"

#include <algorithm>
#include <cmath>

namespace stereovox {
namespace {

constexpr double kPathTolerance = 0.1;  // evo's delta_tol: relative to the wanted length

std::vector<IndexPair> consecutive(std::span<const std::size_t> ends) {
  std::vector<IndexPair> pairs;
  for (std::size_t k = 1; k < ends.size(); ++k) pairs.emplace_back(ends[k - 1], ends[k]);
  return pairs;
}

std::vector<IndexPair> consecutive_pairs_by_path(std::span<const SE3> poses, double delta_m) {
  std::vector<std::size_t> ends;
  double since_last_m = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) since_last_m += (poses[i].translation - poses[i - 1].translation).norm();
    if (since_last_m < delta_m) continue;
    ends.push_back(i);
    since_last_m = 0.0;
  }
  return consecutive(ends);
}

std::vector<IndexPair> all_pairs_by_path(std::span<const SE3> poses, double delta_m) {
  const std::vector<double> way_m = way_along(poses);
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const auto miss_m = [&](double w_m) { return std::abs(w_m - way_m[i] - delta_m); };
    const auto later = std::span(way_m).subspan(i + 1);
    const auto nearest = std::ranges::min_element(later, {}, miss_m);
    if (miss_m(*nearest) <= kPathTolerance * delta_m)
      pairs.emplace_back(i, i + 1 + static_cast<std::size_t>(nearest - later.begin()));
  }
  return pairs;
}

}  // namespace

SE3 relative_pose_error(const PosePairs& pairs, std::size_t i, std::size_t j) {
  const SE3 true_motion = inverse(pairs.truth[i]) * pairs.truth[j];
  const SE3 estimated_motion = inverse(pairs.estimate[i]) * pairs.estimate[j];
  return inverse(true_motion) * estimated_motion;
}

std::vector<double> way_along(std::span<const SE3> poses) {
  std::vector<double> way_m = {0.0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    way_m.push_back(way_m.back() + (poses[i].translation - poses[i - 1].translation).norm());
  return way_m;
}

std::vector<IndexPair> pairs_by_frames(std::size_t count, double delta, bool all_pairs) {
  const auto step = static_cast<std::size_t>(std::max(1LL, std::llround(delta)));
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i + step < count; i += all_pairs ? 1 : step)
    pairs.emplace_back(i, i + step);
  return pairs;
}

std::vector<IndexPair> pairs_by_path(std::span<const SE3> poses, double delta_m, bool all_pairs) {
  return all_pairs ? all_pairs_by_path(poses, delta_m) : consecutive_pairs_by_path(poses, delta_m);
}

}  // namespace stereovox
