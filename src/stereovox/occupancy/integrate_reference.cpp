#include "stereovox/occupancy/integrate_reference.h"

#include <map>
#include <set>

#include "stereovox/occupancy/frame_observation.h"
#include "stereovox/occupancy/voxel_ray.h"
#include "stereovox/occupancy/voxel_update.h"

namespace stereovox {
namespace {

using VoxelSet = std::set<Eigen::Vector3i, LatticeOrder>;
template <class Value>
using PerVoxel = std::map<Eigen::Vector3i, Value, LatticeOrder>;

std::vector<PointMeasurement> measured_points(const FrameView& frame, int step) {
  std::vector<PointMeasurement> points;
  for (int v = first_sample(step); v < frame.disparity.height(); v += step)
    for (int u = first_sample(step); u < frame.disparity.width(); u += step)
      if (const auto point = measure_pixel(frame, u, v)) points.push_back(*point);
  return points;
}

std::vector<PointMeasurement> surface_points(const FrameView& frame) {
  std::vector<PointMeasurement> points = measured_points(frame, frame.steps.surface_px);
  std::erase_if(points, [&](const PointMeasurement& p) { return !marks_surface(frame, p); });
  return points;
}

PerVoxel<VoxelEvidence> gather_evidence(const FrameView& frame,
                                        const std::vector<PointMeasurement>& points) {
  const double size_m = frame.params.voxel_size_m;
  PerVoxel<VoxelEvidence> evidence;
  for (const PointMeasurement& point : points) {
    const Eigen::Vector3i own = voxel_index_of(size_m, point.p_world);
    const auto add = [&](const Eigen::Vector3i& voxel, float value) {
      evidence[voxel].add(value, voxel == own);
    };
    std::visit([&](const auto& model) { for_each_observed_voxel(model, point, size_m, add); },
               frame.params.observation);
  }
  return evidence;
}

float join(const FrameView& frame, const Eigen::Vector3i& voxel, const VoxelEvidence& evidence) {
  return std::visit(
      [&](const auto& union_rule, const auto& density) {
        return observation_of(evidence, expected_points(frame, voxel), union_rule, density);
      },
      frame.params.union_rule, frame.params.density);
}

VoxelSet voxels_on_rays(const FrameView& frame) {
  VoxelSet crossed;
  for (const PointMeasurement& point : measured_points(frame, frame.steps.ray_px))
    if (const auto segment = free_segment(frame, point))
      for_each_voxel_on_segment(segment->from, segment->to, frame.params.voxel_size_m,
                                [&](const Eigen::Vector3i& voxel) { crossed.insert(voxel); });
  return crossed;
}

VoxelSet voxels_in_frustum(const FrameView& frame) {
  const auto [min, max] = frustum_bounds(frame);
  VoxelSet inside;
  for (int x = min.x(); x <= max.x(); ++x)
    for (int y = min.y(); y <= max.y(); ++y)
      for (int z = min.z(); z <= max.z(); ++z)
        if (is_in_frustum(frame, {x, y, z})) inside.insert({x, y, z});
  return inside;
}

VoxelSet observed_besides_hits(const FrameView& frame, const VoxelMap& map) {
  if (frame.params.observed_set == ObservedSet::raycast) return voxels_on_rays(frame);
  VoxelSet observed = voxels_in_frustum(frame);
  if (frame.params.observed_set == ObservedSet::frustum) return observed;
  for (const VoxelBlock* block : map.sorted_blocks())
    for (int i = 0; i < kVoxelsPerBlock; ++i)
      if (const Eigen::Vector3i voxel = voxel_at(block->index, i); is_known(map.at(voxel)))
        observed.insert(voxel);
  return observed;
}

double heterogeneity_of(const Eigen::Vector3i& voxel, const PerVoxel<float>& observations,
                        const HomogeneityParams& params) {
  std::vector<float> neighbours;
  for (const Eigen::Vector3i& step : neighbour_steps(params.neighbours)) {
    const auto found = observations.find(voxel + step);
    neighbours.push_back(found == observations.end() ? kUnobserved : found->second);
  }
  return heterogeneity(params, observations.at(voxel), neighbours);
}

double credibility_of(const Voxel& voxel, double heterogeneity, const FrameView& frame,
                      std::uint32_t frames_before) {
  return std::visit(
      [&](const auto& rule) {
        return rule.credibility(
            {.prior_observations = voxel.observations,
             .homogeneity = homogeneity(frame.params.homogeneity, heterogeneity),
             .age_factor = is_known(voxel) ? rule.age_factor(age_s(voxel, frame.stamp_ms)) : 1.0,
             .frames_before = frames_before});
      },
      frame.params.update);
}

void update_map(const FrameView& frame, const PerVoxel<float>& observations, VoxelMap& map) {
  for (const auto& [index, observation] : observations) {
    const double H = heterogeneity_of(index, observations, frame.params.homogeneity);
    Voxel& voxel = map.find_or_create_block(block_of(index))
                       .voxels[static_cast<std::size_t>(position_in_block(index))];
    const double k = credibility_of(voxel, H, frame, map.frames_integrated);
    update_voxel(observation, k, frame.params.initial_state, frame.stamp_ms, voxel);
  }
}

}  // namespace

FrameUpdate integrate_reference(const DisparityImage& disparity, const RectifiedCamera& camera,
                                const SE3& T_world_camera, std::int64_t stamp_ns,
                                const OccupancyParams& params, int /*threads*/, VoxelMap& map) {
  const FrameView frame = view_frame(disparity, camera, T_world_camera, stamp_ns, params, map);
  const std::vector<PointMeasurement> points = surface_points(frame);

  PerVoxel<float> observations;
  for (const Eigen::Vector3i& voxel : observed_besides_hits(frame, map)) observations[voxel] = 0.0F;
  FrameUpdate update;
  update.points_used = static_cast<int>(points.size());
  for (const auto& [voxel, evidence] : gather_evidence(frame, points)) {
    const float observation = join(frame, voxel, evidence);
    if (observation <= kMinHitObservation) continue;
    observations[voxel] = observation;
    update.hits.push_back(voxel);
  }
  update_map(frame, observations, map);
  ++map.frames_integrated;
  update.hit_voxels = static_cast<int>(update.hits.size());
  update.free_voxels = static_cast<int>(observations.size()) - update.hit_voxels;
  return update;
}

}  // namespace stereovox
