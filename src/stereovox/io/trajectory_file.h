// Camera poses as text. Readers throw Error "<path>:<line>: ..." for wrong field counts, numbers
// that are not finite, rotations that are none and time stamps that do not increase.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "stereovox/core/trajectory.h"

namespace stereovox {

// TUM form: `timestamp tx ty tz qx qy qz qw`, in seconds and metres, `#` starts a comment.
// Quaternions are normalised; stamps are exact to the nanosecond.
Trajectory read_tum(const std::filesystem::path& path);

// `comment` says which frame the poses are of; each of its lines becomes a `# ` line at the top.
void write_tum(const std::filesystem::path& path, const Trajectory& trajectory,
               const std::string& comment);

// KITTI form: twelve numbers a line, the upper 3x4 part of T_world_camera, row by row; no time.
std::vector<SE3> read_kitti_poses(const std::filesystem::path& path);
// Whether the file holds poses in this form.
bool holds_kitti_poses(const std::filesystem::path& path);
// Of either form; one without times gets `stamps_ns`, one for each pose, or an Error says how many
// there are.
Trajectory read_poses(const std::filesystem::path& path, std::span<const std::int64_t> stamps_ns);
void write_kitti_poses(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace stereovox
