#include "stereovox/core/trajectory.h"

#include <algorithm>
#include <cstdlib>

namespace stereovox {

std::optional<SE3> pose_at(const Trajectory& trajectory, std::int64_t stamp_ns,
                           std::int64_t tolerance_ns, std::int64_t max_gap_ns) {
  const auto after = std::ranges::lower_bound(trajectory, stamp_ns, {}, &StampedPose::stamp_ns);
  const bool has_after = after != trajectory.end();
  const bool has_before = after != trajectory.begin();
  const std::int64_t to_after = has_after ? after->stamp_ns - stamp_ns : INT64_MAX;
  const std::int64_t to_before = has_before ? stamp_ns - std::prev(after)->stamp_ns : INT64_MAX;
  if (std::min(to_after, to_before) <= tolerance_ns)
    return to_after <= to_before ? after->T_world_camera : std::prev(after)->T_world_camera;
  if (!has_after || !has_before || to_after + to_before > max_gap_ns) return std::nullopt;
  const double fraction =
      static_cast<double>(to_before) / static_cast<double>(to_before + to_after);
  return interpolate(std::prev(after)->T_world_camera, after->T_world_camera, fraction);
}

double path_length_m(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length_m +=
        (trajectory[i].T_world_camera.translation - trajectory[i - 1].T_world_camera.translation)
            .norm();
  return length_m;
}

}  // namespace stereovox
