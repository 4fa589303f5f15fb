#include "stereovox/pipeline/build_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/frame_view.h"
#include "stereovox/odometry/odometry.h"
#include "stereovox/pipeline/disparity_store.h"
#include "stereovox/pipeline/map_builder.h"
#include "stereovox/pipeline/matched_frames.h"

namespace stereovox {
namespace {

// A given pose this near in time is the frame's own.
constexpr std::int64_t kPoseTolerance_ns = 1'000'000;
// Between given poses farther apart than this nothing is interpolated.
constexpr std::int64_t kMaxPoseGap_ns = 250'000'000;

OdometryResult place_given_at(const Trajectory& poses, std::int64_t stamp_ns,
                              const SE3& T_left_rectified, double farthest_m) {
  const std::optional<SE3> T_world_left =
      pose_at(poses, stamp_ns, kPoseTolerance_ns, kMaxPoseGap_ns);
  if (!T_world_left) return {.reason = "no pose is given for this time"};
  const Eigen::Vector3d& p = T_world_left->translation;
  if (p.cwiseAbs().maxCoeff() > farthest_m)
    return {.reason =
                fmt::format("the pose at ({:.4g}, {:.4g}, {:.4g}) m is more than {:.0f} m from the "
                            "origin, beyond what a map holds",
                            p.x(), p.y(), p.z(), farthest_m)};
  return {.status = OdometryStatus::tracked, .T_segment_camera = *T_world_left * T_left_rectified};
}

bool are_equal(const cv::Mat1b& a, const cv::Mat1b& b) {
  if (a.size() != b.size()) return false;
  for (int v = 0; v < a.rows; ++v)
    if (!std::equal(a[v], a[v] + a.cols, b[v])) return false;
  return true;
}

OdometryParams odometry_params(const PipelineConfig& config) {
  OdometryParams params = config.odometry;
  if (!config.refine) params.places.attempts = 0;
  return params;
}

// One run. Frames are mapped as they come, or, when the whole way is to be known first, wait in a
// store for the second pass.
class Build {
 public:
  Build(StereoSequence& sequence, const PipelineConfig& config,
        const std::optional<Trajectory>& given_poses, const ProgressSink& sink,
        const std::filesystem::path& store_folder)
      : sequence_(sequence),
        given_poses_(given_poses),
        sink_(sink),
        rectifier_(sequence.rig(), config.rectification),
        frames_(sequence, rectifier_, config),
        odometry_(rectifier_.camera(), odometry_params(config)),
        builder_(rectifier_.camera(), config, given_poses.has_value(), store_folder),
        farthest_m_(farthest_camera_m(with_ranges(config.occupancy, rectifier_.camera()))) {
    if (config.refine && !given_poses) waiting_.emplace(store_folder);
    result_.camera = rectifier_.camera();
    if (!frames_.warning().empty()) warn(frames_.warning());
  }

  BuildResult run() {
    try {
      take_frames();
    } catch (const ResourceError& error) {
      result_.failure = error.what();
    }
    try {
      map_waiting_frames();
    } catch (const ResourceError& error) {
      if (result_.failure.empty()) result_.failure = error.what();
    }
    const std::size_t warned = result_.warnings.size();
    result_.segments = builder_.finish(result_.times, result_.warnings);
    for (std::size_t i = warned; i < result_.warnings.size(); ++i) sink_.warn(result_.warnings[i]);
    if (result_.repeated > 0)
      warn(fmt::format("{} of {} frames show the same images as the one before: mapped once",
                       result_.repeated, result_.frames));
    result_.wall_s = watch_.elapsed().wall_ms / 1e3;
    return std::move(result_);
  }

 private:
  void warn(const std::string& text) {
    result_.warnings.push_back(text);
    sink_.warn(text);
  }

  void take_frames() {
    while (!(result_.was_stopped = sink_.should_stop())) {
      std::optional<MatchedFrame> frame = frames_.next();
      if (!frame) return;
      take(std::move(*frame));
    }
  }

  void take(MatchedFrame frame) {
    const std::int64_t stamp_ns = frame.pair.stamp_ns;
    Duration odometry;
    const OdometryResult motion = timed(odometry, [&] {
      return given_poses_ ? place_given_at(*given_poses_, stamp_ns, rectifier_.T_left_rectified(),
                                           farthest_m_)
                          : odometry_.track(frame.pair, frame.disparity);
    });
    result_.times.add("rectify", frame.rectify);
    result_.times.add("disparity", frame.match);
    result_.times.add("odometry", odometry);
    const bool is_repeated = repeats_the_last(frame.pair);
    Progress progress{.frame = ++result_.frames, .frames = sequence_.info().pairs};
    progress.is_tracked = motion.status == OdometryStatus::tracked;
    progress.inliers = motion.inliers;
    progress.match_ms = frame.match.wall_ms;
    progress.odometry_ms = odometry.wall_ms;
    if (progress.is_tracked && is_repeated) {
      ++result_.repeated;
      frame.disparity = empty_disparities(frame.pair.left.pixels.size());
    }
    if (progress.is_tracked)
      keep({stamp_ns, std::move(frame.disparity), motion.segment, motion.T_segment_camera},
           progress);
    else
      note_lost(stamp_ns, motion.reason);
    progress.elapsed_s = watch_.elapsed().wall_ms / 1e3;
    sink_.frame_done(progress);
  }

  // A picture that comes twice, as of a camera that hangs, is one observation.
  bool repeats_the_last(const RectifiedPair& pair) {
    const bool repeats =
        are_equal(pair.left.pixels, last_left_) && are_equal(pair.right.pixels, last_right_);
    last_left_ = pair.left.pixels;
    last_right_ = pair.right.pixels;
    return repeats;
  }

  void keep(LocatedFrame frame, Progress& progress) {
    ++result_.tracked;
    is_lost_ = false;
    if (!waiting_) {
      map(std::move(frame), progress);
      return;
    }
    const Stopwatch watch;
    waiting_->push_back(frame.disparity);
    result_.times.add("store", watch.elapsed());
  }

  void note_lost(std::int64_t stamp_ns, const std::string& reason) {
    if (!is_lost_) result_.lost.push_back({stamp_ns, stamp_ns, 0, reason});
    is_lost_ = true;
    result_.lost.back().to_ns = stamp_ns;
    ++result_.lost.back().frames;
  }

  void map(LocatedFrame frame, Progress& progress) {
    const int segment = frame.segment;
    const Stopwatch watch;
    builder_.add(std::move(frame), result_.times);
    progress.occupancy_ms = watch.elapsed().wall_ms;
    progress.voxel_blocks = builder_.block_count(segment);
  }

  // A run that was stopped still maps all that it has taken.
  void map_waiting_frames() {
    if (!waiting_) return;
    const std::vector<PlacedFrame> placed = odometry_.placed_frames();
    const Stopwatch watch;
    const bool may_stop = !result_.was_stopped;
    Progress progress{.stage = RunStage::mapping, .frames = static_cast<int>(waiting_->size())};
    for (std::size_t i = 0; i < waiting_->size(); ++i) {
      if (may_stop && (result_.was_stopped = sink_.should_stop())) return;
      map({placed[i].stamp_ns, waiting_->read(i), placed[i].segment, placed[i].T_segment_camera},
          progress);
      progress.is_tracked = true;
      progress.frame = static_cast<int>(i) + 1;
      progress.elapsed_s = watch.elapsed().wall_ms / 1e3;
      sink_.frame_done(progress);
    }
  }

  const Stopwatch watch_;
  StereoSequence& sequence_;
  const std::optional<Trajectory>& given_poses_;
  const ProgressSink& sink_;
  const Rectifier rectifier_;
  MatchedFrames frames_;
  Odometry odometry_;
  MapBuilder builder_;
  const double farthest_m_;                // see farthest_camera_m
  std::optional<DisparityStore> waiting_;  // of all tracked frames, in order
  BuildResult result_;
  cv::Mat1b last_left_, last_right_;
  bool is_lost_ = false;
};

}  // namespace

BuildResult build_maps(StereoSequence& sequence, const PipelineConfig& config,
                       const std::optional<Trajectory>& given_poses, const ProgressSink& progress,
                       const std::filesystem::path& store_folder) {
  return Build(sequence, config, given_poses, progress, store_folder).run();
}

}  // namespace stereovox
