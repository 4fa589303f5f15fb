#include "stereovox/simulation/world.h"

#include <fmt/format.h>

#include <cmath>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

double length_m(const std::vector<Eigen::Vector2d>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

Eigen::Vector2d point_at(const std::vector<Eigen::Vector2d>& path, double way_m) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double side = (path[i] - path[i - 1]).norm();
    if (way_m <= side && side > 0) return path[i - 1] + (path[i] - path[i - 1]) * (way_m / side);
    way_m -= side;
  }
  return path.back();
}

}  // namespace

std::vector<Prism> solids_of(const Person& person, double time_s, int material) {
  constexpr double kBody_m = 0.2, kHead_m = 0.1;  // radii
  constexpr double kHeadShare = 0.14;             // of the height
  const double length = length_m(person.path_m);
  double way = std::fmod(time_s * person.speed_m_s, 2 * length);
  if (way > length) way = 2 * length - way;
  const Eigen::Vector2d at = point_at(person.path_m, way);
  const double head = person.height_m * kHeadShare, body = person.height_m - head;
  std::vector<Prism> solids = {post_prism(at, kBody_m, body, 0.0, material),
                               post_prism(at, kHead_m, head, body, material)};
  for (Prism& solid : solids) solid.texture_origin_m = {at.x(), at.y(), 0.0};
  return solids;
}

void shift(World& world, const Eigen::Vector2d& by_m) {
  const Eigen::Vector3d by3_m(by_m.x(), by_m.y(), 0.0);
  world.min_m += by_m;
  world.max_m += by_m;
  for (Prism& solid : world.solids) {
    for (Eigen::Vector2d& corner : solid.base_m) corner += by_m;
    solid.texture_origin_m += by3_m;
  }
  for (Lamp& lamp : world.lamps) lamp.at_m += by3_m;
  for (DoorOpening& doorway : world.doorways) {
    doorway.a_m += by_m;
    doorway.b_m += by_m;
  }
  for (Person& person : world.people)
    for (Eigen::Vector2d& point : person.path_m) point += by_m;
  for (auto& [name, plan] : world.drives)
    for (Waypoint& waypoint : plan.waypoints) waypoint.at_m += by_m;
}

const DrivePlan& drive_of(const World& world, const std::string& name, const std::string& source) {
  const auto found = world.drives.find(name);
  if (found != world.drives.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, plan] : world.drives) names.push_back(known);
  throw Error(fmt::format("{}: has no drive '{}', only {}", source, name, fmt::join(names, ", ")));
}

}  // namespace stereovox
