// How the points of a frame become the observation O_t of a voxel, as the parameters choose: by the
// models of eqs. (12) and (13), or along the rays by the profile of the update rule. The fast and
// the plain integration share this.
#pragma once

#include <optional>
#include <variant>

#include "stereovox/occupancy/frame_view.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox {

// A voxel with a weaker O_t by the models of eq. (12) is not hit.
inline constexpr float kMinHitObservation = 0.02F;

// A voxel is hit when its O_t is larger.
inline float min_hit_observation(const FrameView& frame) {
  return frame.profile != nullptr ? kMaxFreeProfile : kMinHitObservation;
}

// Calls use(observation), where observation(evidence, expected_points, is_crossed) is O_t of a
// voxel with this evidence, or kNothingSaid. The choice falls once for the frame.
template <class Use>
void with_observation(const FrameView& frame, Use use) {
  const auto by_models = [&](const auto& union_rule, const auto& density) {
    use([&](const VoxelEvidence& evidence, double expected, bool) {
      const float value = observation_of(evidence, expected, union_rule, density);
      return value > kMinHitObservation ? value : kNothingSaid;
    });
  };
  const auto by_profile = [&](const auto& union_rule) {
    use([&](const VoxelEvidence& evidence, double expected, bool is_crossed) {
      return profile_observation_of(evidence, expected, is_crossed, union_rule);
    });
  };
  if (frame.profile != nullptr)
    std::visit(by_profile, frame.params.union_rule);
  else
    std::visit(by_models, frame.params.union_rule, frame.params.density);
}

// Calls visit(voxel, value) for each voxel of which the profile of this point says something.
template <class Visit>
void for_each_profiled_voxel(const SurfaceProfile& profile, const FrameView& frame,
                             const PointMeasurement& point, Visit visit) {
  const std::optional<Segment> segment = profile_segment(frame, point);
  if (!segment) return;
  const double size_m = frame.params.voxel_size_m;
  const Eigen::Vector3d inverse_ray = point.ray_world.cwiseInverse();
  for_each_voxel_on_segment(segment->from, segment->to, size_m, [&](const Eigen::Vector3i& voxel) {
    const Chord chord = chord_in(frame, inverse_ray, voxel);
    if (chord.end_m < chord.begin_m) return;  // the walk touched an edge by rounding
    const auto value = static_cast<float>(profile.observe(point, chord, size_m));
    if (value <= kMaxFreeProfile || value >= kMinOccupiedProfile) visit(voxel, value);
  });
}

}  // namespace stereovox
