#include "stereovox/occupancy/integrate_reference.h"

#include <cmath>
#include <map>
#include <set>

#include "stereovox/occupancy/frame_evidence.h"
#include "stereovox/occupancy/frame_visibility.h"
#include "stereovox/occupancy/free_space.h"
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
    if (frame.profile != nullptr) {
      for_each_profiled_voxel(
          *frame.profile, frame, point,
          [&](const Eigen::Vector3i& voxel, float value) { evidence[voxel].add(value, false); });
      continue;
    }
    const Eigen::Vector3i own = voxel_index_of(size_m, point.p_world);
    const auto add = [&](const Eigen::Vector3i& voxel, float value) {
      evidence[voxel].add(value, voxel == own, is_exact(frame, point));
    };
    std::visit([&](const auto& model) { for_each_observed_voxel(model, point, size_m, add); },
               frame.params.observation);
  }
  return evidence;
}

VoxelSet voxels_on_rays(const FrameView& frame) {
  VoxelSet crossed;
  for (const PointMeasurement& point : measured_points(frame, frame.steps.ray_px))
    if (const auto segment = free_segment(frame, point))
      for_each_voxel_on_segment(segment->from, segment->to, frame.params.voxel_size_m,
                                [&](const Eigen::Vector3i& voxel) { crossed.insert(voxel); });
  return crossed;
}

// The same as seen in the image.
VoxelSet voxels_seen_free(const FrameView& frame) {
  const int step = frame.steps.ray_px, first = first_sample(step);
  const auto samples = [&](int pixels) { return (pixels - first + step - 1) / step; };
  ReachPyramid reach(samples(frame.disparity.width()), samples(frame.disparity.height()));
  for (int v = 0; v < reach.height(); ++v)
    for (int u = 0; u < reach.width(); ++u)
      reach.row(v)[u] = reach_of(free_end_m(frame, first + u * step, first + v * step),
                                 frame.params.voxel_size_m);
  reach.build();

  const FreeSpaceView view = free_space_view(frame);
  const int reach_voxels =
      static_cast<int>(std::ceil(frame.params.max_clearing_m / frame.params.voxel_size_m)) + 1;
  VoxelSet crossed;
  for (int x = -reach_voxels; x <= reach_voxels; ++x)
    for (int y = -reach_voxels; y <= reach_voxels; ++y)
      for (int z = -reach_voxels; z <= reach_voxels; ++z)
        if (const Eigen::Vector3i voxel = view.camera_voxel + Eigen::Vector3i(x, y, z);
            is_crossed(view, reach, voxel))
          crossed.insert(voxel);
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
  if (frame.params.observed_set == ObservedSet::projected) return voxels_seen_free(frame);
  VoxelSet observed = voxels_in_frustum(frame);
  if (frame.params.observed_set == ObservedSet::frustum) return observed;
  map.for_each_block([&](const VoxelBlock& block) {
    for (int i = 0; i < kVoxelsPerBlock; ++i)
      if (const Eigen::Vector3i voxel = voxel_at(block.index, i); is_known(map.at(voxel)))
        observed.insert(voxel);
  });
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

// Adds the voxels that points speak for to `observations`, which holds the crossed ones as 0;
// returns those that are hit.
std::vector<Eigen::Vector3i> join_points(const FrameView& frame,
                                         const PerVoxel<VoxelEvidence>& evidence,
                                         PerVoxel<float>& observations) {
  std::vector<Eigen::Vector3i> hits;
  const ExpectedPoints expected_points(frame);
  with_observation(frame, [&](auto observation) {
    for (const auto& [voxel, of_voxel] : evidence) {
      const bool is_crossed = observations.contains(voxel);
      const float value = observation(of_voxel, expected_points.from(voxel), is_crossed);
      if (value == kNothingSaid) continue;
      observations[voxel] = value;
      if (value > min_hit_observation(frame)) hits.push_back(voxel);
    }
  });
  return hits;
}

template <WeighingRule Rule>
void update_map(const Rule& rule, const FrameView& frame, const PerVoxel<float>& observations,
                VoxelMap& map) {
  for (const auto& [index, observation] : observations) {
    const double H = heterogeneity_of(index, observations, frame.params.homogeneity);
    Voxel voxel = map.at(index);
    const double age_factor =
        is_known(voxel) ? rule.age_factor(age_s(voxel.last_seen_ms, frame.stamp_ms)) : 1.0;
    const double k = rule.credibility({.prior_observations = voxel.observations,
                                       .homogeneity = homogeneity(frame.params.homogeneity, H),
                                       .age_factor = age_factor,
                                       .frames_before = map.frames_integrated});
    update_voxel(observation, k, frame.params.initial_state, frame.stamp_ms, voxel);
    map.set(index, voxel);
  }
}

template <AddingRule Rule>
void update_map(const Rule& rule, const FrameView& frame, const PerVoxel<float>& observations,
                VoxelMap& map) {
  for (const auto& [index, observation] : observations) {
    Voxel voxel = map.at(index);
    store(rule.after(belief_of(voxel), observation), frame.stamp_ms, voxel);
    map.set(index, voxel);
  }
}

// P(V) of one voxel when that of the one before it is known.
double visibility_of(const VisibilityRule& rule, const FrameView& frame, const VoxelMap& map,
                     const Eigen::Vector3i& voxel, const PerVoxel<float>& nearer) {
  const Eigen::Vector3i camera =
      voxel_index_of(frame.params.voxel_size_m, frame.T_world_camera.translation);
  if (voxel == camera) return 1.0;
  double hidden = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3i facing = voxel;
    facing[axis] += (camera[axis] > voxel[axis]) - (camera[axis] < voxel[axis]);
    if (facing != voxel) hidden = std::min(hidden, rule.occupancy(map.at(facing)));
  }
  const int axis = entry_axis(frame, voxel, camera - voxel);
  Eigen::Vector3i before = voxel;
  before[axis] += camera[axis] > voxel[axis] ? 1 : -1;
  const auto found = nearer.find(before);
  return rule.visibility(found == nearer.end() ? 1.0 : static_cast<double>(found->second), hidden);
}

PerVoxel<float> visibilities(const VisibilityRule& rule, const FrameView& frame,
                             const PerVoxel<float>& observations, const VoxelMap& map) {
  const Eigen::Vector3i camera =
      voxel_index_of(frame.params.voxel_size_m, frame.T_world_camera.translation);
  std::multimap<int, Eigen::Vector3i> outward;
  for (const auto& [voxel, observation] : observations)
    outward.emplace((voxel - camera).cwiseAbs().sum(), voxel);
  PerVoxel<float> visibility;
  for (const auto& [steps, voxel] : outward)
    visibility[voxel] = static_cast<float>(visibility_of(rule, frame, map, voxel, visibility));
  return visibility;
}

void update_map(const VisibilityRule& rule, const FrameView& frame,
                const PerVoxel<float>& observations, VoxelMap& map) {
  const PerVoxel<float> visibility = visibilities(rule, frame, observations, map);
  for (const auto& [index, observation] : observations) {
    Voxel voxel = map.at(index);
    update_voxel(rule, observation, static_cast<double>(visibility.at(index)), frame.stamp_ms,
                 voxel);
    map.set(index, voxel);
  }
}

// The mean of one pixel and of the pairs around it.
float smoothed_pixel(const DisparityImage& image, const SmoothingParams& params, int v, int u) {
  const auto at = [&](int row, int column) {
    const bool is_inside =
        row >= 0 && column >= 0 && row < image.height() && column < image.width();
    return is_inside ? image.disparity_px(row, column) : 0.0F;
  };
  const float middle_px = image.disparity_px(v, u);
  const float gate_px = static_cast<float>(params.gate_sigmas) * image.sigma_px(v, u);
  const auto counts = [&](float disparity_px) {
    return disparity_px > 0.0F && std::isfinite(disparity_px) &&
           disparity_px >= middle_px - gate_px && disparity_px <= middle_px + gate_px;
  };
  float sum_px = middle_px;
  int count = 1;
  for (int down = 0; down <= params.radius_px; ++down)
    for (int right = -params.radius_px; right <= params.radius_px; ++right) {
      if (down == 0 && right <= 0) continue;
      const float before_px = at(v - down, u - right), after_px = at(v + down, u + right);
      if (!counts(before_px) || !counts(after_px)) continue;
      sum_px += before_px + after_px;
      count += 2;
    }
  return count == 1 ? middle_px : sum_px / static_cast<float>(count);
}

}  // namespace

DisparityImage smoothed_reference(const DisparityImage& image, const SmoothingParams& params) {
  DisparityImage out = image;
  out.disparity_px = image.disparity_px.clone();
  for (int v = 0; v < image.height(); ++v)
    for (int u = 0; u < image.width(); ++u) {
      const float disparity_px = image.disparity_px(v, u);
      if (disparity_px > 0.0F && std::isfinite(disparity_px))
        out.disparity_px(v, u) = smoothed_pixel(image, params, v, u);
    }
  return out;
}

FrameUpdate integrate_reference(const DisparityImage& disparity, const RectifiedCamera& camera,
                                const SE3& T_world_camera, std::int64_t stamp_ns,
                                const OccupancyParams& params, int /*threads*/, VoxelMap& map) {
  const DisparityImage smooth = smoothed_reference(disparity, params.smoothing);
  observe_floor(disparity, camera, T_world_camera, params, map);
  const FrameView frame = view_frame(smooth, camera, T_world_camera, stamp_ns, params, map);
  const std::vector<PointMeasurement> points = surface_points(frame);

  PerVoxel<float> observations;
  for (const Eigen::Vector3i& voxel : observed_besides_hits(frame, map)) observations[voxel] = 0.0F;
  FrameUpdate update;
  update.points_used = static_cast<int>(points.size());
  update.hits = join_points(frame, gather_evidence(frame, points), observations);
  std::visit([&](const auto& rule) { update_map(rule, frame, observations, map); }, params.update);
  ++map.frames_integrated;
  update.hit_voxels = static_cast<int>(update.hits.size());
  update.free_voxels = static_cast<int>(observations.size()) - update.hit_voxels;
  return update;
}

}  // namespace stereovox
