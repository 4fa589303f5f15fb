#include "map_engine_openvdb.h"

#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>

#include <algorithm>

#include "stereovox/core/camera.h"
#include "stereovox/occupancy/frame_view.h"

namespace stereovox::bench {
namespace {

using Ray = openvdb::math::Ray<double>;
using Walk = openvdb::math::DDA<Ray, 0>;  // from voxel to voxel

// OctoMap's: log-odds of 0.7 and of 0.4, held within [0.1192, 0.971].
constexpr float kHit = 0.8473F, kMiss = -0.4055F, kLowest = -2.0F, kHighest = 3.5F;

// In voxels; voxel i covers [i, i + 1).
openvdb::Vec3d in_voxels(const Eigen::Vector3d& p, double voxel_size_m) {
  return {p.x() / voxel_size_m, p.y() / voxel_size_m, p.z() / voxel_size_m};
}

class OpenvdbMap {
 public:
  explicit OpenvdbMap(double voxel_size_m) : voxel_size_m_(voxel_size_m) {}

  void insert(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& origin) {
    openvdb::BoolGrid seen(false);
    auto accessor = seen.getAccessor();
    const openvdb::Vec3d from = in_voxels(origin, voxel_size_m_);
    for (const Eigen::Vector3d& point : points)
      walk_to(in_voxels(point, voxel_size_m_), from, accessor);
    apply(seen);
  }

  State state_at(const Eigen::Vector3d& p) const {
    float value = 0.0F;
    const bool is_known =
        queries_.probeValue(openvdb::Coord::floor(in_voxels(p, voxel_size_m_)), value);
    if (!is_known) return State::unknown;
    return value > 0.0F ? State::occupied : State::free;
  }

  bool hits(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double range_m) const {
    const Ray ray(in_voxels(from, voxel_size_m_), {way.x(), way.y(), way.z()}, 0.0,
                  range_m / voxel_size_m_);
    Walk walk(ray);
    do {
      if (queries_.getValue(walk.voxel()) > 0.0F) return true;
    } while (walk.step());
    return false;
  }

  double bytes_per_voxel() const {
    return static_cast<double>(grid_->memUsage()) / static_cast<double>(grid_->activeVoxelCount());
  }

 private:
  // Flags: active = crossed, true = hit.
  static void walk_to(const openvdb::Vec3d& to, const openvdb::Vec3d& from,
                      openvdb::BoolGrid::Accessor& seen) {
    const openvdb::Coord last = openvdb::Coord::floor(to);
    const openvdb::Vec3d way = to - from;
    const double length = way.length();
    Walk walk(Ray(from, way / length, 0.0, length));
    do {
      if (walk.voxel() == last) break;
      seen.setActiveState(walk.voxel(), true);
    } while (walk.step());
    seen.setValueOn(last, true);
  }

  void apply(const openvdb::BoolGrid& seen) {
    auto accessor = grid_->getAccessor();
    for (auto voxel = seen.cbeginValueOn(); voxel; ++voxel) {
      const float step = *voxel ? kHit : kMiss;
      accessor.modifyValue(voxel.getCoord(), [step](float& log_odds) {
        log_odds = std::clamp(log_odds + step, kLowest, kHighest);
      });
    }
  }

  double voxel_size_m_;
  openvdb::FloatGrid::Ptr grid_ = openvdb::FloatGrid::create(0.0F);
  openvdb::FloatGrid::ConstAccessor queries_ = grid_->getConstAccessor();
};

std::vector<Eigen::Vector3d> points_of(const Frame& frame, const Case& c) {
  const cv::Mat1f& disparity = frame.seen(c.depth).disparity_px;
  std::vector<Eigen::Vector3d> points;
  for (int v = first_sample(c.pixel_step); v < disparity.rows; v += c.pixel_step)
    for (int u = first_sample(c.pixel_step); u < disparity.cols; u += c.pixel_step)
      if (disparity(v, u) > 0.0F)
        points.emplace_back(frame.T_world_camera *
                            triangulate(camera(), u, v, double(disparity(v, u))));
  return points;
}

}  // namespace

bool has_openvdb_peer() { return true; }

Result run_openvdb(const Case& c, const std::vector<Frame>& frames, const Truth& truth) {
  openvdb::initialize();
  OpenvdbMap map(c.voxel_size_m);
  Result result{.name = "OpenVDB", .times = {}, .accuracy = {}};
  for (const Frame& frame : frames) {
    const std::vector<Eigen::Vector3d> points = points_of(frame, c);
    time(result.times, [&] { map.insert(points, frame.T_world_camera.translation); });
  }
  const auto state_at = [&](const Eigen::Vector3d& p) { return map.state_at(p); };
  result.accuracy = accuracy_of(truth, [&](const Eigen::Vector3i& voxel) {
    return state_at(voxel_center_of(c.voxel_size_m, voxel));
  });
  result.bytes_per_voxel = map.bytes_per_voxel();
  result.look_up_ns = look_up_ns(state_at);
  result.ray_us = ray_us(frames, [&](const Eigen::Vector3d& from, const Eigen::Vector3d& way) {
    return map.hits(from, way, kMaxRange_m);
  });
  return result;
}

}  // namespace stereovox::bench
