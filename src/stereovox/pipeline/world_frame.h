// Where the floor is: places the frame of a camera trajectory into a world with z up.
//
// With the camera's own motion only, the world's origin lies on the floor below the first camera
// and x points where that camera looks, unless the parameters place it elsewhere. Given poses keep
// their own world when its z is up.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"
#include "stereovox/stereo/ground_plane.h"

namespace stereovox {

enum class LevelSource { ground_plane, given };
std::span<const std::string> names_of(LevelSource);

struct WorldFrameParams {
  LevelSource level = LevelSource::ground_plane;
  double camera_height_m = 0.5;
  double camera_pitch_deg = 0.0;
  double start_x_m = 0.0, start_y_m = 0.0, start_yaw_deg = 0.0;
  int frames = 5;
  GroundPlaneParams ground_plane;

  void describe(ParameterList& list) {
    list("level", level,
         "height and tilt of the camera: from the ground plane in the first frames, or as given");
    list("camera_height_m", camera_height_m, {-1000, 1000},
         "of the first camera above the floor, where no ground plane is used or found");
    list("camera_pitch_deg", camera_pitch_deg, {-90, 90},
         "of the first camera, positive looking down, where no ground plane is used or found");
    list("start_x_m", start_x_m, {-1e6, 1e6},
         "where the first camera stands in the world, unless poses are given");
    list("start_y_m", start_y_m, {-1e6, 1e6}, "likewise");
    list("start_yaw_deg", start_yaw_deg, {-360, 360},
         "where it looks, counter-clockwise from the world's x axis");
    list("frames", frames, {1, 100},
         "first frames of a segment in which the ground plane is sought");
    list.section("ground_plane", ground_plane);
  }
};

// One of the first frames of a segment, and the floor if it shows one.
struct GroundView {
  SE3 T_segment_camera;
  std::optional<GroundPlane> plane;
};

struct WorldFrame {
  SE3 T_world_segment;
  double floor_z_m = 0.0;
  std::string source;       // one line for the user: how it was found, with the numbers
  bool is_assumed = false;  // nobody saw the floor, or said where it is
};

// For a trajectory that odometry began at its first camera. Only the first segment begins at the
// start pose; nothing is known of where later ones begin.
WorldFrame world_of_odometry(std::span<const GroundView> views, const WorldFrameParams& params,
                             bool is_first_segment = true);

// For given poses: their world when its z axis is up, otherwise a levelled one.
WorldFrame world_of_given_poses(std::span<const GroundView> views, const WorldFrameParams& params);

}  // namespace stereovox
