#include "stereovox/simulation/write_data_set.h"

#include <fmt/format.h>

#include <ostream>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/pfm.h"
#include "stereovox/io/text_file.h"
#include "stereovox/io/trajectory_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
}

// One form of data set: where the images of a frame go, and what is written when all are there.
struct Form {
  std::function<std::pair<fs::path, fs::path>(int index, std::int64_t stamp_ns)> image_paths;
  std::function<void(const Trajectory& written)> finish;
};

Form plain_form(const fs::path& folder, const StereoRig& rig) {
  make_folder(folder / "left");
  make_folder(folder / "right");
  const auto finish = [=](const Trajectory& written) {
    const PinholeCamera& camera = rig.left.pinhole;
    write_text_atomically(
        folder / "calib.yaml",
        fmt::format("width: {}\nheight: {}\nfx: {}\nfy: {}\ncx: {}\ncy: {}\nbaseline: {}\n",
                    camera.width, camera.height, camera.fx_px, camera.fy_px, camera.cx_px,
                    camera.cy_px, rig.baseline_m()));
    std::string times;
    for (const StampedPose& pose : written) times += seconds_text(pose.stamp_ns) + "\n";
    write_text_atomically(folder / "times.txt", times);
    write_tum(folder / "poses.txt", written, "T_world_camera of the left camera, exact");
  };
  const auto paths = [=](int index, std::int64_t) {
    const std::string name = fmt::format("{:06d}.png", index);
    return std::pair(folder / "left" / name, folder / "right" / name);
  };
  return {paths, finish};
}

std::string sensor_yaml(const CameraCalibration& camera, const SE3& T_body_sensor) {
  const Eigen::Matrix3d R = T_body_sensor.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = T_body_sensor.translation;
  std::vector<double> T;
  for (int row = 0; row < 3; ++row) T.insert(T.end(), {R(row, 0), R(row, 1), R(row, 2), t(row)});
  T.insert(T.end(), {0, 0, 0, 1});
  std::vector<double> distortion = camera.distortion;
  distortion.resize(4);
  const PinholeCamera& p = camera.pinhole;
  return fmt::format(
      "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\nresolution: [{}, {}]\n"
      "camera_model: pinhole\nintrinsics: [{}, {}, {}, {}]\n"
      "distortion_model: radial-tangential\ndistortion_coefficients: [{}]\n",
      fmt::join(T, ", "), p.width, p.height, p.fx_px, p.fy_px, p.cx_px, p.cy_px,
      fmt::join(distortion, ", "));
}

// The body is the left camera.
void write_euroc_tables(const fs::path& mav, const StereoRig& rig, const Trajectory& written) {
  std::string images = "#timestamp [ns],filename\n", truth = "#timestamp,p,q_wxyz,v,bw,ba\n";
  for (const StampedPose& pose : written) {
    const Eigen::Vector3d& t = pose.T_world_camera.translation;
    const Eigen::Quaterniond& q = pose.T_world_camera.rotation;
    images += fmt::format("{0},{0}.png\n", pose.stamp_ns);
    truth += fmt::format("{},{},{},{},{},{},{},{},0,0,0,0,0,0,0,0,0\n", pose.stamp_ns, t.x(), t.y(),
                         t.z(), q.w(), q.x(), q.y(), q.z());
  }
  write_text_atomically(mav / "cam0" / "sensor.yaml", sensor_yaml(rig.left, SE3{}));
  write_text_atomically(mav / "cam1" / "sensor.yaml",
                        sensor_yaml(rig.right, inverse(rig.T_right_left)));
  for (const char* camera : {"cam0", "cam1"})
    write_text_atomically(mav / camera / "data.csv", images);
  write_text_atomically(mav / "state_groundtruth_estimate0" / "data.csv", truth);
}

Form euroc_form(const fs::path& folder, const StereoRig& rig) {
  const fs::path mav = folder / "mav0";
  for (const char* name : {"cam0/data", "cam1/data", "state_groundtruth_estimate0"})
    make_folder(mav / name);
  const auto paths = [=](int, std::int64_t stamp_ns) {
    const std::string name = fmt::format("{}.png", stamp_ns);
    return std::pair(mav / "cam0" / "data" / name, mav / "cam1" / "data" / name);
  };
  return {paths, [=](const Trajectory& written) { write_euroc_tables(mav, rig, written); }};
}

void write_truth(const fs::path& folder, const Simulation& simulation, int index) {
  const Simulation::Truth truth = simulation.truth(index);
  const auto path = [&](const char* kind, const char* extension) {
    make_folder(folder / kind);
    return folder / kind / fmt::format("{:06d}.{}", index, extension);
  };
  write_pfm(path("depth", "pfm"), truth.depth_m);
  if (truth.disparity_px.empty()) return;
  write_pfm(path("disparity", "pfm"), truth.disparity_px);
  write_png(path("occluded", "png"), truth.occluded);
}

}  // namespace

int write_data_set(const fs::path& folder, const Simulation& simulation,
                   const DataSetOptions& options) {
  const StereoRig& rig = simulation.rig();
  const Form form = rig.is_rectified ? plain_form(folder, rig) : euroc_form(folder, rig);
  const int frames = static_cast<int>(simulation.trajectory().size());
  int written = 0;
  for (; written < frames && !options.should_stop(); ++written) {
    const std::int64_t stamp_ns =
        simulation.trajectory()[static_cast<std::size_t>(written)].stamp_ns;
    const auto [left, right] = form.image_paths(written, stamp_ns);
    if (!options.keep_existing || !fs::exists(left) || !fs::exists(right)) {
      const StereoFrame frame = simulation.frame(written);
      write_png(left, frame.left.pixels);
      write_png(right, frame.right.pixels);
    }
    if (options.truth_every > 0 && written % options.truth_every == 0)
      write_truth(folder / "truth", simulation, written);
    options.progress(written + 1, frames);
  }
  form.finish({simulation.trajectory().begin(), simulation.trajectory().begin() + written});
  return written;
}

}  // namespace stereovox
