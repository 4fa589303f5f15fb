#include "stereovox/pipeline/world_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/core/angles.h"

namespace stereovox {
namespace {

// Views whose floors differ by less than this see the same floor.
constexpr double kSameTilt_rad = 3.0 * kDegree_rad;
constexpr double kSameHeight_share = 0.1;
// Cosine between the cameras' mean upward axis and z from which a given world counts as z up.
constexpr double kUpward = 0.5;
// A floor in a z-up world is level, but for the error of its estimate.
constexpr double kLevelTolerance_rad = 10.0 * kDegree_rad;

// The plane down . p = height in segment coordinates.
struct Floor {
  Eigen::Vector3d down;
  double height_m;
  double camera_height_m;
};

std::vector<Floor> floors_of(std::span<const GroundView> views) {
  std::vector<Floor> floors;
  for (const GroundView& view : views)
    if (view.plane) {
      const Eigen::Vector3d down = view.T_segment_camera.rotation * view.plane->down_camera;
      floors.push_back({down, view.plane->height_m + down.dot(view.T_segment_camera.translation),
                        view.plane->height_m});
    }
  return floors;
}

bool agree(const Floor& a, const Floor& b) {
  return std::acos(std::clamp(a.down.dot(b.down), -1.0, 1.0)) < kSameTilt_rad &&
         std::abs(a.height_m - b.height_m) < kSameHeight_share * a.camera_height_m;
}

// The mean of the floors that agree with the one most others agree with; nothing when fewer than
// half of the views agree.
std::optional<Floor> common_floor(std::span<const GroundView> views) {
  const std::vector<Floor> floors = floors_of(views);
  std::vector<Floor> best;
  for (const Floor& candidate : floors) {
    std::vector<Floor> agreeing;
    std::ranges::copy_if(floors, std::back_inserter(agreeing),
                         [&](const Floor& other) { return agree(candidate, other); });
    if (agreeing.size() > best.size()) best = agreeing;
  }
  if (best.empty() || 2 * best.size() < views.size()) return std::nullopt;
  Floor mean{Eigen::Vector3d::Zero(), 0.0, 0.0};
  for (const Floor& floor : best) {
    mean.down += floor.down;
    mean.height_m += floor.height_m / static_cast<double>(best.size());
    mean.camera_height_m += floor.camera_height_m / static_cast<double>(best.size());
  }
  mean.down.normalize();
  return mean;
}

Floor given_floor(const SE3& T_segment_camera, const WorldFrameParams& params) {
  const double pitch_rad = params.camera_pitch_deg * kDegree_rad;
  const Eigen::Vector3d down =
      T_segment_camera.rotation * Eigen::Vector3d(0.0, std::cos(pitch_rad), std::sin(pitch_rad));
  return {down, params.camera_height_m + down.dot(T_segment_camera.translation),
          params.camera_height_m};
}

enum class Source { seen, given, assumed };

struct FoundFloor {
  Floor floor;
  Source source;
  std::string text;
};

double height_above(const Floor& floor, const SE3& T_segment_camera) {
  return floor.height_m - floor.down.dot(T_segment_camera.translation);
}

std::string describe_camera(const Floor& floor, const SE3& T_segment_camera, Source source) {
  constexpr const char* kHow[] = {"from the ground plane in the first frames", "as given",
                                  "assumed: no ground plane was found; give both "
                                  "--camera-height and --camera-pitch"};
  const Eigen::Vector3d forward = T_segment_camera.rotation * Eigen::Vector3d::UnitZ();
  const double pitch_deg = std::asin(std::clamp(forward.dot(floor.down), -1.0, 1.0)) / kDegree_rad;
  return fmt::format("camera {:.3f} m above the floor, pitched down {:.1f} deg ({})",
                     height_above(floor, T_segment_camera), pitch_deg,
                     kHow[static_cast<int>(source)]);
}

FoundFloor find_floor(std::span<const GroundView> views, const WorldFrameParams& params) {
  const bool is_given = params.level == LevelSource::given;
  const std::optional<Floor> seen = is_given ? std::nullopt : common_floor(views);
  const Source source = seen ? Source::seen : is_given ? Source::given : Source::assumed;
  const SE3& T_segment_camera = views.front().T_segment_camera;
  const Floor floor = seen.value_or(given_floor(T_segment_camera, params));
  return {floor, source, describe_camera(floor, T_segment_camera, source)};
}

// z up, x where the camera looks, origin on the floor below the camera.
SE3 level_world(const Floor& floor, const SE3& T_segment_camera) {
  const Eigen::Vector3d up = -floor.down;
  const Eigen::Vector3d left = -(T_segment_camera.rotation * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d y = (left - up * up.dot(left)).normalized();
  Eigen::Matrix3d R_segment_world;
  R_segment_world << y.cross(up), y, up;
  const Eigen::Vector3d below_camera =
      T_segment_camera.translation + height_above(floor, T_segment_camera) * floor.down;
  return inverse(SE3{Eigen::Quaterniond(R_segment_world).normalized(), below_camera});
}

SE3 start_pose(const WorldFrameParams& params) {
  const double yaw_rad = params.start_yaw_deg * std::numbers::pi / 180;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())),
          {params.start_x_m, params.start_y_m, 0.0}};
}

bool is_z_up(std::span<const GroundView> views) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const GroundView& view : views)
    up -= view.T_segment_camera.rotation * Eigen::Vector3d::UnitY();
  return up.normalized().z() > kUpward;
}

}  // namespace

std::span<const std::string> names_of(LevelSource) {
  static const std::vector<std::string> names = {"ground_plane", "given"};
  return names;
}

WorldFrame world_of_odometry(std::span<const GroundView> views, const WorldFrameParams& params,
                             bool is_first_segment) {
  const FoundFloor found = find_floor(views, params);
  const SE3 T_level_segment = level_world(found.floor, views.front().T_segment_camera);
  const SE3 T_world_level = is_first_segment ? start_pose(params) : SE3{};
  return {T_world_level * T_level_segment, 0.0, found.text, found.source == Source::assumed};
}

WorldFrame world_of_given_poses(std::span<const GroundView> views, const WorldFrameParams& params) {
  const FoundFloor found = find_floor(views, params);
  const SE3& T_segment_camera = views.front().T_segment_camera;
  if (!is_z_up(views))
    return {level_world(found.floor, T_segment_camera), 0.0,
            "z of the given poses is not up, so the world was levelled: " + found.text,
            found.source == Source::assumed};
  const bool is_level = -found.floor.down.z() > std::cos(kLevelTolerance_rad);
  if (found.source == Source::assumed || (found.source == Source::seen && !is_level))
    return {SE3{}, 0.0, "floor taken at z = 0 of the given poses: no level ground plane was found",
            true};
  const double floor_z_m =
      T_segment_camera.translation.z() - height_above(found.floor, T_segment_camera);
  return {SE3{}, floor_z_m,
          fmt::format("floor at z = {:.3f} m of the given poses: {}", floor_z_m, found.text)};
}

}  // namespace stereovox
