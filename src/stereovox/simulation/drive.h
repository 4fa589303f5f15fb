// The way of the robot through a world, as a function of time: straight lines between way-points,
// rounded corners, turns on the spot.
#pragma once

#include <cstdint>
#include <vector>

#include "stereovox/simulation/world.h"

namespace stereovox {

struct PlanarPose {
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;  // 0 = along x, counter-clockwise
};

// A piece of the way, driven at constant speed and turn rate.
struct Motion {
  PlanarPose start;
  double length_m = 0.0, turn_rad = 0.0;
  double duration_s = 0.0;

  PlanarPose at(double time_s) const;  // since its start, within [0, duration_s]
};

// Corners are cut with the given radius where the way is long enough for it; the robot turns on the
// spot where it must turn back. `jitter_m` moves each way-point by up to so much, by `seed`.
struct DriveStyle {
  double speed_m_s = 0.2;
  double turn_rate_rad_s = 0.5;
  double corner_radius_m = 0.4;
  double jitter_m = 0.0;
};

std::vector<Motion> motions_of(const DrivePlan& plan, const DriveStyle& style, std::uint32_t seed);

// Where the robot is every 1 / rate_hz seconds, from the start to the end of the way.
std::vector<PlanarPose> sample(const std::vector<Motion>& motions, double rate_hz);

// Throws Error "<source>: drive '<name>' comes within 0.12 m of 'table' at (3.1, 2.2)" when a pose
// lies nearer than `radius_m` to a solid between the heights `above_m` and `below_m`.
struct Clearance {
  double radius_m = 0.2;
  double above_m = 0.03, below_m = 1.5;
};
void check_clearance(const World& world, const std::vector<PlanarPose>& poses,
                     const Clearance& clearance, const std::string& drive,
                     const std::string& source);

}  // namespace stereovox
