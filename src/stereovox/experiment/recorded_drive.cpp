#include "stereovox/experiment/recorded_drive.h"

#include <fmt/format.h>

#include <fstream>
#include <map>
#include <ostream>

#include "stereovox/core/error.h"
#include "stereovox/dataset/open_sequence.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/disparity_file.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/trajectory_file.h"
#include "stereovox/odometry/odometry.h"
#include "stereovox/pipeline/matched_frames.h"
#include "stereovox/simulation/world_file.h"
#include "stereovox/simulation/write_data_set.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// Counts up when the simulator draws other images for the same parameters.
constexpr int kRendererVersion = 1;
constexpr std::uint64_t kMaxKeyBytes = 16ULL << 20;
constexpr const char *kKeyFile = "key.txt", *kEstimatedFile = "estimated.tum";
// Says that every pair was rendered: one that was stopped leaves a data set, too, but a short one.
constexpr const char* kRenderedFile = "rendered.txt";

template <class Params>
std::string key_of(Params params, const std::string& only_sections = "") {
  std::string text;
  const ParameterList list = parameters_of(params);
  for (const Parameter& p : list.parameters())
    if (only_sections.empty() ||
        only_sections.find(p.path.substr(0, p.path.find('.')) + ";") != std::string::npos)
      text += fmt::format("{}={}\n", p.path, p.get());
  return text;
}

// The folder for a key; the key is written into it, so that two with one name are noticed.
fs::path keyed_folder(const fs::path& parent, const std::string& name, const std::string& key) {
  fs::path folder = parent / (name + "_" + content_name(key));
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
  const fs::path file = folder / kKeyFile;
  if (!fs::exists(file)) write_text_atomically(file, key);
  if (read_file(file, kMaxKeyBytes) != key)
    throw Error(file.string() + ": belongs to other data with the same name; remove its folder");
  return folder;
}

std::string render_key(const RecordingRequest& request) {
  return fmt::format("renderer {}\ndrive={}\n{}{}", kRendererVersion, request.drive,
                     key_of(request.simulation), read_file(request.world, kMaxKeyBytes));
}

std::string match_key(const RecordingRequest& request) {
  return fmt::format("build {}\n{}", request.build,
                     key_of(request.pipeline, "rectification;matcher;odometry;refine;"));
}

fs::path disparity_path(const fs::path& folder, int frame) {
  return folder / fmt::format("disparity_{:06d}.png", frame);
}
fs::path sigma_path(const fs::path& folder, int frame) {
  return folder / fmt::format("sigma_{:06d}.png", frame);
}

// False when it was stopped.
bool render_into(const fs::path& folder, const Simulation& simulation,
                 const RecordingProgress& progress) {
  if (fs::exists(folder / kRenderedFile)) return true;
  DataSetOptions options{.truth_every = 0, .keep_existing = true};
  options.should_stop = progress.should_stop;
  const int frames = static_cast<int>(simulation.trajectory().size());
  const int step = std::max(1, frames / 10);
  options.progress = [&](int done, int all) {
    if (done % step == 0) progress.say(fmt::format("rendered {} of {} pairs", done, all));
  };
  if (write_data_set(folder, simulation, options) < frames) return false;
  write_text_atomically(folder / kRenderedFile, fmt::format("{} pairs\n", frames));
  return true;
}

// Poses of the first segment in the world of the true first pose; with `refine`, of all that could
// be tied to it.
Trajectory match_into(const fs::path& folder, StereoSequence& sequence, const SE3& T_world_first,
                      const PipelineConfig& config, const RecordingProgress& progress) {
  const Rectifier rectifier(sequence.rig(), config.rectification);
  PipelineConfig one_thread = config;
  one_thread.threads = 1;
  MatchedFrames frames(sequence, rectifier, one_thread);
  Odometry odometry(rectifier.camera(), config.odometry);
  Trajectory estimated;
  for (int i = 0; const std::optional<MatchedFrame> frame = frames.next(); ++i) {
    if (progress.should_stop()) return {};
    const OdometryResult motion = odometry.track(frame->pair, frame->disparity);
    if (!config.refine && motion.status == OdometryStatus::tracked && motion.segment == 0)
      estimated.push_back({frame->pair.stamp_ns, T_world_first * motion.T_segment_camera});
    write_disparity(disparity_path(folder, i), frame->disparity);
    write_disparity(sigma_path(folder, i), {frame->disparity.sigma_px, {}});
  }
  if (!config.refine) return estimated;
  for (const PlacedFrame& frame : odometry.placed_frames())
    if (frame.segment == 0)
      estimated.push_back({frame.stamp_ns, T_world_first * frame.T_segment_camera});
  return estimated;
}

std::vector<RecordedPose> joined(const Trajectory& truth, const Trajectory& estimated) {
  std::map<std::int64_t, SE3> by_stamp;
  for (const StampedPose& pose : estimated) by_stamp[pose.stamp_ns] = pose.T_world_camera;
  std::vector<RecordedPose> poses;
  for (const StampedPose& pose : truth) {
    const auto found = by_stamp.find(pose.stamp_ns);
    poses.push_back({pose.stamp_ns, pose.T_world_camera,
                     found == by_stamp.end() ? std::nullopt : std::optional(found->second)});
  }
  return poses;
}

}  // namespace

// FNV-1a, 64 bit.
std::string content_name(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return fmt::format("{:016x}", hash);
}

DisparityImage RecordedDrive::disparity(int frame) const {
  return {read_disparity(disparity_path(folder, frame)).disparity_px,
          read_disparity(sigma_path(folder, frame)).disparity_px};
}

std::optional<RecordedDrive> record_drive(const fs::path& cache, const RecordingRequest& request,
                                          int threads, const RecordingProgress& progress) {
  RecordedDrive drive;
  drive.simulation =
      std::make_shared<Simulation>(read_world(request.world), request.drive, request.simulation,
                                   request.world.string(), threads);
  const fs::path images = keyed_folder(cache, request.name, render_key(request));
  if (!render_into(images, *drive.simulation, progress)) return std::nullopt;

  drive.key = render_key(request) + match_key(request);
  drive.folder = keyed_folder(images, "matched", match_key(request));
  const std::unique_ptr<StereoSequence> sequence = open_sequence(images, {}, {});
  drive.camera = Rectifier(sequence->rig(), request.pipeline.rectification).camera();
  const Trajectory& truth = drive.simulation->trajectory();
  const fs::path estimated_file = drive.folder / kEstimatedFile;
  if (!fs::exists(estimated_file)) {
    const Trajectory estimated = match_into(drive.folder, *sequence, truth.front().T_world_camera,
                                            request.pipeline, progress);
    if (progress.should_stop()) return std::nullopt;
    progress.say(
        fmt::format("matched; odometry tracked {} of {} frames", estimated.size(), truth.size()));
    write_tum(estimated_file, estimated, "T_world_camera of the left camera, by odometry");
  }
  drive.poses = joined(truth, read_tum(estimated_file));
  return drive;
}

}  // namespace stereovox
