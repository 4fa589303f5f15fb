#include "map_engine_world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stereovox/core/grid_geometry.h"
#include "stereovox/core/parallel.h"
#include "stereovox/occupancy/voxel_ray.h"

namespace stereovox::bench {
namespace {

constexpr int kThreads = 2;
constexpr double kLength_m = 16.023, kWidth_m = 12.017, kFloor_m = 0.013, kCeiling_m = 2.887;
constexpr double kOutside_m = 0.31, kDoorTop_m = 2.112;

class Builder {
 public:
  void add(Eigen::Vector3d low, Eigen::Vector3d high, bool is_thin = false) {
    boxes.push_back({low, high, is_thin});
  }
  void add_shell() {
    const Eigen::Vector3d low(-kOutside_m, -kOutside_m, -kOutside_m);
    const Eigen::Vector3d high(kLength_m + kOutside_m, kWidth_m + kOutside_m,
                               kCeiling_m + kOutside_m);
    add(low, {high.x(), high.y(), kFloor_m});
    add({low.x(), low.y(), kCeiling_m}, high);
    add(low, {0.021, high.y(), high.z()});
    add({kLength_m, low.y(), low.z()}, high);
    add(low, {high.x(), 0.023, high.z()});
    add({low.x(), kWidth_m, low.z()}, high);
  }
  // A wall across x with a door from `door_m` on.
  void add_wall(double x_m, double door_m) {
    constexpr double kThickness_m = 0.121, kDoor_m = 1.249;
    add({x_m, 0, 0}, {x_m + kThickness_m, door_m, kCeiling_m});
    add({x_m, door_m + kDoor_m, 0}, {x_m + kThickness_m, kWidth_m, kCeiling_m});
    add({x_m, door_m, kDoorTop_m}, {x_m + kThickness_m, door_m + kDoor_m, kCeiling_m});
  }
  void add_pillar(double x_m, double y_m) {
    constexpr double kHalf_m = 0.203;
    add({x_m - kHalf_m, y_m - kHalf_m, 0}, {x_m + kHalf_m, y_m + kHalf_m, kCeiling_m});
  }
  // A table with four legs, a screen on it and a chair before it.
  void add_desk(double x_m, double y_m) {
    constexpr double kX_m = 1.6, kY_m = 0.8, kLeg_m = 0.05, kInset_m = 0.01;
    add({x_m, y_m, 0.717}, {x_m + kX_m, y_m + kY_m, 0.758});
    for (const double leg_x : {x_m + kInset_m, x_m + kX_m - kInset_m - kLeg_m})
      for (const double leg_y : {y_m + kInset_m, y_m + kY_m - kInset_m - kLeg_m})
        add({leg_x, leg_y, 0}, {leg_x + kLeg_m, leg_y + kLeg_m, 0.717}, true);
    add({x_m + 0.5, y_m + 0.6, 0.86}, {x_m + 1.03, y_m + 0.64, 1.21}, true);
    add_chair(x_m + 0.6, y_m - 0.55);
  }
  void add_chair(double x_m, double y_m) {
    add({x_m, y_m, 0.43}, {x_m + 0.45, y_m + 0.45, 0.49});
    add({x_m + 0.2, y_m + 0.2, 0}, {x_m + 0.26, y_m + 0.26, 0.43}, true);
    add({x_m, y_m, 0.49}, {x_m + 0.45, y_m + 0.04, 0.96}, true);
  }

  std::vector<Box> boxes;
};

// Distance along `ray` (in units of it) to the first box; infinite when there is none.
double first_hit(const std::vector<Box>& boxes, const Eigen::Vector3d& from,
                 const Eigen::Vector3d& ray) {
  const Eigen::Array3d inverse = ray.array().inverse();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Box& box : boxes) {
    const Eigen::Array3d a = (box.low_m - from).array() * inverse;
    const Eigen::Array3d b = (box.high_m - from).array() * inverse;
    const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
    if (in <= out && in > 0.0 && in < nearest) nearest = in;
  }
  return nearest;
}

std::uint64_t mixed(std::uint64_t x) {  // splitmix64
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

double normal_number(std::uint64_t key) {  // Box and Muller
  const auto uniform = [](std::uint64_t bits) {
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
  };
  return std::sqrt(-2.0 * std::log(uniform(mixed(2 * key)))) *
         std::cos(2.0 * std::numbers::pi * uniform(mixed(2 * key + 1)));
}

void see_row(const std::vector<Box>& boxes, int v, std::uint64_t seed, Frame& frame) {
  constexpr int kSeedBit = 40;  // above all pixels of all frames
  const PinholeCamera& c = camera().pinhole;
  const Eigen::Matrix3d R = frame.T_world_camera.rotation.toRotationMatrix();
  for (int u = 0; u < c.width; ++u) {
    const Eigen::Vector3d ray((u - c.cx_px) / c.fx_px, (v - c.cy_px) / c.fy_px, 1.0);
    const double depth_m = first_hit(boxes, frame.T_world_camera.translation, R * ray);
    const double length = ray.norm();
    if (depth_m * length > kMaxRange_m) continue;
    const auto disparity_px = static_cast<float>(camera().disparity_px(depth_m));
    frame.clean.disparity_px(v, u) = disparity_px;
    const auto pixel = static_cast<std::uint64_t>((frame.number * c.height + v) * c.width + u);
    const std::uint64_t key = (seed << kSeedBit) + pixel;
    const float noisy_px = disparity_px + kNoise_px * static_cast<float>(normal_number(key));
    if (noisy_px > 0.0F && camera().depth_m(double(noisy_px)) * length <= kMaxRange_m)
      frame.noisy.disparity_px(v, u) = noisy_px;
  }
}

template <class Visit>
void for_each_voxel_in(const Truth& truth, const Eigen::Vector3d& low_m,
                       const Eigen::Vector3d& high_m, Visit visit) {
  const Eigen::Vector3i first = voxel_index_of(truth.voxel_size_m, low_m).cwiseMax(truth.low);
  const Eigen::Vector3i last = voxel_index_of(truth.voxel_size_m, high_m)
                                   .cwiseMin(truth.low + truth.size - Eigen::Vector3i::Ones());
  Eigen::Vector3i voxel;
  for (voxel.z() = first.z(); voxel.z() <= last.z(); ++voxel.z())
    for (voxel.y() = first.y(); voxel.y() <= last.y(); ++voxel.y())
      for (voxel.x() = first.x(); voxel.x() <= last.x(); ++voxel.x()) visit(voxel);
}

void note_boxes(const std::vector<Box>& boxes, Truth& truth) {
  const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(0.5 * truth.voxel_size_m);
  for (const Box& box : boxes) {
    const std::uint8_t kind = Truth::kSolid | (box.is_thin ? Truth::kThin : 0);
    for_each_voxel_in(truth, box.low_m, box.high_m,
                      [&](const Eigen::Vector3i& v) { truth.at(v) |= kind; });
    for_each_voxel_in(truth, box.low_m - margin_m, box.high_m + margin_m,
                      [&](const Eigen::Vector3i& v) { truth.at(v) |= Truth::kNearSolid; });
  }
}

void note_rays(const Frame& frame, Truth& truth) {
  const PinholeCamera& c = camera().pinhole;
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const float disparity_px = frame.clean.disparity_px(v, u);
      if (disparity_px == 0.0F) continue;
      const Eigen::Vector3d end =
          frame.T_world_camera * triangulate(camera(), u, v, double(disparity_px));
      for_each_voxel_on_segment(
          frame.T_world_camera.translation, end, truth.voxel_size_m,
          [&](const Eigen::Vector3i& voxel) { truth.at(voxel) |= Truth::kCrossed; });
      truth.at(voxel_index_of(truth.voxel_size_m, end)) |= Truth::kHit;
    }
}

}  // namespace

std::vector<Box> office() {
  Builder b;
  b.add_shell();
  b.add_wall(7.031, 5.963);
  b.add_wall(12.517, 1.523);
  for (const auto& [x, y] : {std::pair(4.517, 9.028), {9.527, 2.519}, {10.033, 9.321}})
    b.add_pillar(x, y);
  for (const auto& [x, y] : {std::pair(1.013, 0.817),
                             {3.217, 0.817},
                             {4.863, 3.618},
                             {0.613, 8.127},
                             {2.917, 7.213},
                             {8.513, 3.833},
                             {8.121, 9.837},
                             {10.031, 6.017},
                             {13.513, 5.033},
                             {13.713, 9.333}})
    b.add_desk(x, y);
  b.add({0.021, 2.512, 0}, {0.473, 4.127, 1.823});
  b.add({6.527, 3.317, 0}, {7.031, 4.512, 1.223});
  b.add({11.617, 7.317, 0}, {12.517, 7.812, 1.923});
  b.add({5.213, 11.463, 0}, {6.313, 12.017, 2.123});
  b.add({3.613, 5.817, 0}, {4.052, 6.263, 0.413});
  b.add({5.713, 6.917, 0}, {6.152, 7.263, 0.613});
  b.add({6.013, 4.913, 0}, {6.043, 4.943, 1.713}, true);
  b.add({9.113, 5.317, 0}, {9.552, 5.863, 0.313});
  b.add({3.513, 3.913, 2.313}, {4.713, 4.113, 2.413});
  return b.boxes;
}

RectifiedCamera camera() {
  return {.pinhole = {.width = 640,
                      .height = 480,
                      .fx_px = 525.0,
                      .fy_px = 525.0,
                      .cx_px = 319.5,
                      .cy_px = 239.5},
          .baseline_m = 0.12};
}

SE3 pose_at(int frame) {
  constexpr double kSpeed_mps = 0.2, kRate_hz = 5.0, kTurn_rad = 0.7, kTurnPeriod_s = 16.0;
  const Eigen::Vector3d start_m(2.2, 3.2, 1.1), door_m(7.1, 6.6, 1.1);
  const double t_s = frame / kRate_hz, turn = 2.0 * std::numbers::pi * t_s;
  const Eigen::Vector3d way = (door_m - start_m).normalized();
  const double yaw = std::atan2(way.y(), way.x()) + kTurn_rad * std::sin(turn / kTurnPeriod_s);
  const double pitch = 0.06 + 0.02 * std::sin(turn / 3.1), roll = 0.015 * std::sin(turn / 2.3);
  Eigen::Matrix3d R_level_camera;
  R_level_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const auto about = [](double angle, int axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
  };
  return {about(yaw, 2) * about(pitch, 1) * about(roll, 0) * Eigen::Quaterniond(R_level_camera),
          start_m + kSpeed_mps * t_s * way};
}

Frame see_office(const std::vector<Box>& boxes, int number, std::uint64_t seed) {
  const PinholeCamera& c = camera().pinhole;
  const auto image = [&](float sigma_px) {
    return DisparityImage{.disparity_px = cv::Mat1f(c.height, c.width, 0.0F),
                          .sigma_px = cv::Mat1f(c.height, c.width, sigma_px)};
  };
  Frame frame{number, pose_at(number), image(0.0F), image(kNoise_px)};
  parallel_for(0, c.height, kThreads, [&](int v) { see_row(boxes, v, seed, frame); });
  return frame;
}

bool Truth::contains(const Eigen::Vector3i& voxel) const {
  const Eigen::Array3i place = (voxel - low).array();
  return (place >= 0).all() && (place < size.array()).all();
}

std::uint8_t& Truth::at(const Eigen::Vector3i& voxel) {
  const Eigen::Vector3i place = voxel - low;
  const auto row = static_cast<std::size_t>(place.z() * size.y() + place.y());
  return voxels[row * static_cast<std::size_t>(size.x()) + static_cast<std::size_t>(place.x())];
}

Truth truth_of(const std::vector<Box>& boxes, const std::vector<Frame>& frames,
               double voxel_size_m) {
  Truth truth{.voxel_size_m = voxel_size_m, .low = {}, .size = {}, .voxels = {}};
  const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(0.5);
  truth.low = voxel_index_of(voxel_size_m, -margin_m);
  truth.size =
      voxel_index_of(voxel_size_m, Eigen::Vector3d(kLength_m, kWidth_m, kCeiling_m) + margin_m) -
      truth.low;
  truth.voxels.assign(static_cast<std::size_t>(truth.size.prod()), 0);
  note_boxes(boxes, truth);
  for (const Frame& frame : frames) note_rays(frame, truth);
  return truth;
}

}  // namespace stereovox::bench
