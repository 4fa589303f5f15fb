#include "stereovox/dataset/kitti_layout.h"

#include <fmt/format.h>

#include "stereovox/core/error.h"
#include "stereovox/dataset/calibration.h"
#include "stereovox/dataset/pairing.h"
#include "stereovox/dataset/stamps.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/trajectory_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

fs::path image_folder(const fs::path& folder, int camera) {
  return folder / fmt::format("image_{}", camera);
}

// Grey images are preferred: they were recorded without a colour filter. The right camera is the
// next.
int left_camera(const fs::path& folder) {
  const bool has_grey = fs::is_directory(image_folder(folder, 0));
  const bool has_colour = fs::is_directory(image_folder(folder, 2));
  return has_grey || !has_colour ? 0 : 2;
}

// calib.txt holds none.
cv::Size image_size(const fs::path& folder) {
  const fs::path left = image_folder(folder, left_camera(folder));
  return first_size_of(images_in(left), left);
}

KittiCalibration calibration_of(const fs::path& folder) {
  const int left = left_camera(folder);
  return read_kitti_calibration(folder / "calib.txt", left, left + 1, image_size(folder));
}

fs::path poses_file(const fs::path& folder) {
  if (fs::exists(folder / "poses.txt")) return folder / "poses.txt";
  const fs::path sequence = fs::canonical(folder);
  const fs::path beside =
      sequence.parent_path().parent_path() / "poses" / (sequence.filename().string() + ".txt");
  return fs::exists(beside) ? beside : fs::path();
}

Trajectory read_truth(const fs::path& poses, const std::vector<std::int64_t>& times_ns,
                      const SE3& T_cam0_left) {
  const std::vector<SE3> T_world_cam0 = read_kitti_poses(poses);
  if (T_world_cam0.size() != times_ns.size())
    throw Error(fmt::format("{}: has {} poses, times.txt has {} times", poses.string(),
                            T_world_cam0.size(), times_ns.size()));
  Trajectory truth;
  for (const std::size_t i : choose_increasing(times_ns).kept)
    truth.push_back({times_ns[i], T_world_cam0[i] * T_cam0_left});
  return truth;
}

}  // namespace

bool is_kitti_layout(const fs::path& folder) {
  for (const int camera : {0, 1, 2, 3})
    if (fs::is_directory(image_folder(folder, camera))) return true;
  return false;
}

StereoRig kitti_rig(const fs::path& folder) { return calibration_of(folder).rig; }

SequenceListing list_kitti_layout(const fs::path& folder, const SequenceParams& params) {
  const int left = left_camera(folder);
  const NamedImages images{image_folder(folder, left), image_folder(folder, left + 1),
                           folder / "times.txt"};
  SequenceListing listing = pair_by_name(images, params.assumed_rate_hz);
  const fs::path poses = poses_file(folder);
  if (poses.empty()) return listing;
  std::vector<std::string> remarks_given_before;
  const std::vector<std::int64_t> times_ns =
      read_times(images.times_file, images_in(images.left_folder).size(), params.assumed_rate_hz,
                 remarks_given_before);
  listing.truth = read_truth(poses, times_ns, calibration_of(folder).T_cam0_left);
  return listing;
}

}  // namespace stereovox
