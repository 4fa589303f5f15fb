#include "stereovox/simulation/drive.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNothing = 1e-9;
// Sharper corners are turned on the spot.
constexpr double kSharpestCorner_rad = 2.6;
// A corner may use up to this share of each of its sides; the next corner needs the rest.
constexpr double kShareOfSide = 0.45;

Eigen::Vector2d direction(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

double heading_of(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

// In (-pi, pi].
double turn_between(double from_rad, double to_rad) {
  return kPi - std::fmod(3 * kPi - std::remainder(to_rad - from_rad, 2 * kPi), 2 * kPi);
}

// Lays one motion after the other.
class WayBuilder {
 public:
  WayBuilder(const PlanarPose& start, const DriveStyle& style) : pose_(start), style_(style) {}

  void go(double length_m, double turn_rad) {
    if (length_m < kNothing && std::abs(turn_rad) < kNothing) return;
    const double duration =
        std::max(length_m / style_.speed_m_s, std::abs(turn_rad) / style_.turn_rate_rad_s);
    motions_.push_back({pose_, length_m, turn_rad, duration});
    pose_ = motions_.back().at(duration);
  }
  void straight_to(const Eigen::Vector2d& p) { go((p - pose_.at_m).norm(), 0.0); }
  void turn_to(double heading_rad) { go(0.0, turn_between(pose_.heading_rad, heading_rad)); }
  const PlanarPose& pose() const { return pose_; }
  std::vector<Motion> take() { return std::move(motions_); }

 private:
  PlanarPose pose_;
  DriveStyle style_;
  std::vector<Motion> motions_;
};

// From the side that ends at `corner` to the one that leads to `next`.
void round_corner(WayBuilder& way, const Eigen::Vector2d& corner, const Eigen::Vector2d& next,
                  double radius_m) {
  const Eigen::Vector2d in = corner - way.pose().at_m, out = next - corner;
  const double turn = turn_between(heading_of(in), heading_of(out));
  const double tangent = std::tan(std::abs(turn) / 2);
  const double reach =
      std::min({radius_m * tangent, kShareOfSide * in.norm(), kShareOfSide * out.norm()});
  if (std::abs(turn) > kSharpestCorner_rad || reach < kNothing) {
    way.straight_to(corner);
    way.turn_to(heading_of(out));
    return;
  }
  way.straight_to(corner - in.normalized() * reach);
  way.go(reach / tangent * std::abs(turn), turn);
}

std::vector<Waypoint> jittered(std::vector<Waypoint> waypoints, double jitter_m,
                               std::uint32_t seed) {
  const auto offset = [&](int i, int axis) {
    return jitter_m * (hash_of(i, axis, 0, seed) / 2147483647.5 - 1.0);
  };
  for (std::size_t i = 0; i < waypoints.size(); ++i)
    waypoints[i].at_m +=
        Eigen::Vector2d(offset(static_cast<int>(i), 0), offset(static_cast<int>(i), 1));
  return waypoints;
}

double distance_to(const Prism& solid, const Eigen::Vector2d& p, const Clearance& clearance) {
  const Polygon2D base = base_between(solid, clearance.above_m, clearance.below_m);
  return base.empty() ? std::numeric_limits<double>::infinity() : distance_m(base, p);
}

}  // namespace

PlanarPose Motion::at(double time_s) const {
  const double done = duration_s > 0 ? std::clamp(time_s / duration_s, 0.0, 1.0) : 1.0;
  const double turned = turn_rad * done, way = length_m * done;
  // The chord of an arc leaves its start at half of the angle turned.
  const double chord =
      std::abs(turned) < kNothing ? way : way * std::sin(turned / 2) / (turned / 2);
  return {start.at_m + chord * direction(start.heading_rad + turned / 2),
          start.heading_rad + turned};
}

std::vector<Motion> motions_of(const DrivePlan& plan, const DriveStyle& style, std::uint32_t seed) {
  const std::vector<Waypoint> points = jittered(plan.waypoints, style.jitter_m, seed);
  const Eigen::Vector2d first =
      points.size() > 1 ? Eigen::Vector2d(points[1].at_m - points[0].at_m) : Eigen::Vector2d(1, 0);
  WayBuilder way({points[0].at_m, heading_of(first)}, style);
  way.go(0.0, points[0].turn_deg * kPi / 180);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d to = points[i].at_m - way.pose().at_m;
    if (to.norm() < kNothing) continue;
    way.turn_to(heading_of(to));  // only where the last piece did not end in that direction
    const bool stops = points[i].turn_deg != 0.0 || i + 1 == points.size();
    if (stops) {
      way.straight_to(points[i].at_m);
      way.go(0.0, points[i].turn_deg * kPi / 180);
    } else {
      round_corner(way, points[i].at_m, points[i + 1].at_m, style.corner_radius_m);
    }
  }
  return way.take();
}

std::vector<PlanarPose> sample(const std::vector<Motion>& motions, double rate_hz) {
  std::vector<PlanarPose> poses;
  double begin_s = 0.0;
  for (const Motion& motion : motions) {
    for (; static_cast<double>(poses.size()) / rate_hz < begin_s + motion.duration_s;)
      poses.push_back(motion.at(static_cast<double>(poses.size()) / rate_hz - begin_s));
    begin_s += motion.duration_s;
  }
  if (!motions.empty()) poses.push_back(motions.back().at(motions.back().duration_s));
  return poses;
}

void check_clearance(const World& world, const std::vector<PlanarPose>& poses,
                     const Clearance& clearance, const std::string& drive,
                     const std::string& source) {
  for (const PlanarPose& pose : poses)
    for (const Prism& solid : world.solids) {
      const double distance = distance_to(solid, pose.at_m, clearance);
      if (distance >= clearance.radius_m) continue;
      throw Error(fmt::format("{}: drive '{}' comes within {:.2f} m of '{}' at ({:.2f}, {:.2f})",
                              source, drive, distance, solid.name, pose.at_m.x(), pose.at_m.y()));
    }
}

}  // namespace stereovox
