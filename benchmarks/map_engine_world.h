// The scene of the map engine's benchmark: an office of axis-aligned boxes, seen on a drive by a
// stereo camera without error or with the noise of a matcher, and what the frames show of it,
// exactly. Nothing random but the noise, which is a function of seed, frame and pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/se3.h"

namespace stereovox::bench {

struct Box {
  Eigen::Vector3d low_m, high_m;
  bool is_thin = false;  // a leg, a back or a pole of a few centimetres
};

// 16 x 12 x 2.9 m. The floor's top is a little above z = 0, and no face lies on a voxel's face.
std::vector<Box> office();

// 640 x 480 pixels, 63 degrees wide.
RectifiedCamera camera();

// Where the camera is at a frame of the drive: 0.2 m/s at 5 Hz through a door, looking around.
SE3 pose_at(int frame);

enum class Depth { clean, noisy };

// Standard deviation of the noisy disparities.
inline constexpr float kNoise_px = 0.5F;

struct Frame {
  int number = 0;
  SE3 T_world_camera;
  DisparityImage clean, noisy;  // of points within kMaxRange_m

  const DisparityImage& seen(Depth depth) const { return depth == Depth::clean ? clean : noisy; }
};

inline constexpr double kMaxRange_m = 8.0;

// `seed` chooses the noise.
Frame see_office(const std::vector<Box>& boxes, int number, std::uint64_t seed = 0);

// A lattice over the office and what the frames show of it without noise.
struct Truth {
  enum : std::uint8_t { kCrossed = 1, kHit = 2, kSolid = 4, kNearSolid = 8, kThin = 16 };

  double voxel_size_m = 0.05;
  Eigen::Vector3i low, size;
  std::vector<std::uint8_t> voxels;

  bool contains(const Eigen::Vector3i& voxel) const;
  std::uint8_t& at(const Eigen::Vector3i& voxel);
  std::uint8_t at(const Eigen::Vector3i& voxel) const {
    return contains(voxel) ? const_cast<Truth&>(*this).at(voxel) : 0;
  }
};

Truth truth_of(const std::vector<Box>& boxes, const std::vector<Frame>& frames,
               double voxel_size_m);

}  // namespace stereovox::bench
