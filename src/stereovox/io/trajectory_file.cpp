#include "stereovox/io/trajectory_file.h"

#include <fmt/format.h>

#include <optional>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::size_t kKittiFields = 12;
constexpr double kMinQuaternionNorm = 1e-6;
// Published pose files carry six to seven digits, some four.
constexpr double kRotationTolerance = 1e-2;

Eigen::Quaterniond unit_quaternion(const TextRecord& record) {
  const Eigen::Quaterniond q(record.number(7), record.number(4), record.number(5),
                             record.number(6));
  if (q.norm() < kMinQuaternionNorm) throw Error(record.place() + ": the quaternion is zero");
  return q.normalized();
}

StampedPose tum_pose(const TextRecord& record) {
  record.expect_fields(8);
  return {record.stamp_ns(0),
          {unit_quaternion(record), {record.number(1), record.number(2), record.number(3)}}};
}

SE3 kitti_pose(const TextRecord& record) {
  record.expect_fields(kKittiFields);
  Eigen::Matrix<double, 3, 4> T;
  for (int i = 0; i < 12; ++i) T(i / 4, i % 4) = record.number(static_cast<std::size_t>(i));
  const NearestRotation nearest = nearest_rotation(T.leftCols<3>());
  if (nearest.residual > kRotationTolerance)
    throw Error(fmt::format("{}: the 3x3 part is not a rotation (off by {:.3g})", record.place(),
                            nearest.residual));
  return {nearest.rotation, T.col(3)};
}

}  // namespace

Trajectory read_tum(const std::filesystem::path& path) {
  Trajectory trajectory;
  for_each_record(path, [&](const TextRecord& record) {
    const StampedPose pose = tum_pose(record);
    if (!trajectory.empty() && pose.stamp_ns <= trajectory.back().stamp_ns)
      throw Error(fmt::format("{}: time {} does not come after {}", record.place(),
                              seconds_text(pose.stamp_ns),
                              seconds_text(trajectory.back().stamp_ns)));
    trajectory.push_back(pose);
  });
  return trajectory;
}

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory,
               const std::string& comment) {
  write_file_atomically(path, [&](std::ostream& out) {
    std::istringstream lines(comment);
    for (std::string line; std::getline(lines, line);) out << "# " << line << '\n';
    for (const auto& [stamp_ns, T] : trajectory) {
      const Eigen::Vector3d& t = T.translation;
      const Eigen::Quaterniond& q = T.rotation;
      out << fmt::format("{} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n",
                         seconds_text(stamp_ns), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    }
  });
}

std::vector<SE3> read_kitti_poses(const std::filesystem::path& path) {
  std::vector<SE3> poses;
  for_each_record(path, [&](const TextRecord& record) { poses.push_back(kitti_pose(record)); });
  return poses;
}

bool holds_kitti_poses(const std::filesystem::path& path) {
  std::optional<std::size_t> fields;
  for_each_record(path, [&](const TextRecord& record) {
    if (!fields) fields = record.fields.size();
  });
  return fields == kKittiFields;
}

Trajectory read_poses(const std::filesystem::path& path, std::span<const std::int64_t> stamps_ns) {
  if (!holds_kitti_poses(path)) return read_tum(path);
  const std::vector<SE3> poses = read_kitti_poses(path);
  if (poses.size() != stamps_ns.size())
    throw Error(fmt::format("{}: has {} poses without times, for {} frames", path.string(),
                            poses.size(), stamps_ns.size()));
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) trajectory.push_back({stamps_ns[i], poses[i]});
  return trajectory;
}

void write_kitti_poses(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_file_atomically(path, [&](std::ostream& out) {
    for (const StampedPose& pose : trajectory) {
      Eigen::Matrix<double, 4, 3> columns;  // stored column by column: the rows of the 3x4 matrix
      columns.topRows<3>() = pose.T_world_camera.rotation.toRotationMatrix().transpose();
      columns.row(3) = pose.T_world_camera.translation.transpose();
      std::string line;
      for (const double value : columns.reshaped()) line += fmt::format("{:.9g} ", value);
      line.back() = '\n';
      out << line;
    }
  });
}

}  // namespace stereovox
