// A place that can be driven through, as it is described; nothing of it comes from images.
// World frame: z up, the floor at z = 0.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "stereovox/simulation/material.h"
#include "stereovox/simulation/prism.h"

namespace stereovox {

struct Lamp {
  Eigen::Vector3d at_m;
  double power = 1.0;  // brightness of a white surface 1 m below it
};

// A passage through a wall: the segment between its jambs.
struct DoorOpening {
  std::string name;
  Eigen::Vector2d a_m, b_m;
};

// Walks up and down a way.
struct Person {
  std::vector<Eigen::Vector2d> path_m;
  double speed_m_s = 1.0, height_m = 1.75;
};

struct Waypoint {
  Eigen::Vector2d at_m;
  double turn_deg = 0.0;  // a turn on the spot after arriving, positive to the left
};

struct DrivePlan {
  std::vector<Waypoint> waypoints;
  double speed_m_s = 0.2, rate_hz = 5.0;
};

struct World {
  std::string name;
  Eigen::Vector2d min_m, max_m;  // extent of the map: the floor, outer walls included
  std::vector<Material> materials;
  std::vector<Prism> solids;
  std::vector<Lamp> lamps;
  double ambient = 0.35;  // light from all sides, relative to a lamp's
  std::vector<DoorOpening> doorways;
  std::vector<Person> people;
  std::map<std::string, DrivePlan> drives;
};

// The solids of a person at a time, in place.
std::vector<Prism> solids_of(const Person& person, double time_s, int material);

// Moves everything in the plane.
void shift(World& world, const Eigen::Vector2d& by_m);

// Throws Error "<source>: ..." for a drive that the world does not have.
const DrivePlan& drive_of(const World& world, const std::string& name, const std::string& source);

}  // namespace stereovox
