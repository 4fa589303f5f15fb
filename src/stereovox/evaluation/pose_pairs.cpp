#include "stereovox/evaluation/pose_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "stereovox/core/error.h"
#include "stereovox/core/timestamp.h"

namespace stereovox {
namespace {

struct Match {
  std::size_t in_short, in_long;
  std::int64_t difference_ns;
};

// Of two equally near ones the earlier. `trajectory` is not empty.
std::size_t nearest_in_time(const Trajectory& trajectory, std::int64_t stamp_ns) {
  const auto after = std::ranges::lower_bound(trajectory, stamp_ns, {}, &StampedPose::stamp_ns);
  if (after == trajectory.begin()) return 0;
  const auto before = std::prev(after);
  const bool is_after_nearer =
      after != trajectory.end() && after->stamp_ns - stamp_ns < stamp_ns - before->stamp_ns;
  return static_cast<std::size_t>((is_after_nearer ? after : before) - trajectory.begin());
}

std::vector<Match> match(const Trajectory& fewer, const Trajectory& more,
                         std::int64_t max_difference_ns) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < fewer.size(); ++i) {
    const std::size_t nearest = nearest_in_time(more, fewer[i].stamp_ns);
    const std::int64_t difference_ns = std::abs(more[nearest].stamp_ns - fewer[i].stamp_ns);
    if (difference_ns > max_difference_ns) continue;
    // Both are in the order of time, so only the last claim can be on the same pose.
    const bool is_claimed = !matches.empty() && matches.back().in_long == nearest;
    if (!is_claimed)
      matches.push_back({i, nearest, difference_ns});
    else if (difference_ns < matches.back().difference_ns)
      matches.back() = {i, nearest, difference_ns};
  }
  return matches;
}

std::string time_span(const Trajectory& trajectory) {
  return fmt::format("{:.6g} .. {:.6g} s", seconds_from_ns(trajectory.front().stamp_ns),
                     seconds_from_ns(trajectory.back().stamp_ns));
}

void require_poses(std::size_t truth, std::size_t estimate) {
  if (truth == 0) throw Error("trajectories: the truth has no poses");
  if (estimate == 0) throw Error("trajectories: the estimate has no poses");
}

}  // namespace

PosePairs match_by_stamp(const Trajectory& truth, const Trajectory& estimate,
                         double max_stamp_difference_s) {
  require_poses(truth.size(), estimate.size());
  const bool truth_is_short = truth.size() < estimate.size();
  const std::vector<Match> matches =
      match(truth_is_short ? truth : estimate, truth_is_short ? estimate : truth,
            ns_from_seconds(max_stamp_difference_s));
  if (matches.empty())
    throw Error(
        fmt::format("trajectories: no matching time stamps within {} s (truth {}, estimate {})",
                    max_stamp_difference_s, time_span(truth), time_span(estimate)));

  PosePairs pairs;
  for (const Match& m : matches) {
    pairs.truth.push_back(truth[truth_is_short ? m.in_short : m.in_long].T_world_camera);
    pairs.estimate.push_back(estimate[truth_is_short ? m.in_long : m.in_short].T_world_camera);
  }
  pairs.unmatched_truth = static_cast<int>(truth.size() - matches.size());
  pairs.unmatched_estimate = static_cast<int>(estimate.size() - matches.size());
  return pairs;
}

PosePairs match_by_index(std::span<const SE3> truth, std::span<const SE3> estimate) {
  require_poses(truth.size(), estimate.size());
  if (truth.size() != estimate.size())
    throw Error(fmt::format(
        "trajectories: the truth has {} poses, the estimate {}; without time stamps the numbers "
        "must be equal",
        truth.size(), estimate.size()));
  return {{truth.begin(), truth.end()}, {estimate.begin(), estimate.end()}};
}

}  // namespace stereovox
