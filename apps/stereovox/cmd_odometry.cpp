// stereovox odometry SOURCE -o t.tum: camera motion only.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "command.h"
#include "interrupt.h"
#include "stereovox/core/timestamp.h"
#include "stereovox/io/trajectory_file.h"
#include "stereovox/pipeline/matched_frames.h"

namespace stereovox {
namespace {

struct OdometryOptions {
  SourceOptions source;
  ConfigOptions config;
  std::string output, kitti_output;
  bool verbose = false;
};

struct Tracked {
  std::map<int, Trajectory> segments;
  int frames = 0, lost = 0;
  StageTimes times;
};

void report_frame(const MatchedFrame& frame, const OdometryResult& motion, bool verbose) {
  const double time_s = seconds_from_ns(frame.pair.stamp_ns);
  if (motion.status == OdometryStatus::lost)
    warn(fmt::format("frame {} at {:.3f} s is lost: {}", frame.index, time_s, motion.reason));
  else if (verbose)
    std::cout << fmt::format(
        "frame {} at {:.3f} s: {} of {} points fit, {} of {} matches agree, rms {:.2f} px\n",
        frame.index, time_s, motion.inliers, motion.expected, motion.consistent, motion.matches,
        motion.rms_px);
}

Tracked track(StereoSequence& sequence, const PipelineConfig& config, bool verbose) {
  const Rectifier rectifier(sequence.rig(), config.rectification);
  MatchedFrames frames(sequence, rectifier, config);
  if (!frames.warning().empty()) warn(frames.warning());
  Odometry odometry(rectifier.camera(), config.odometry);
  Tracked tracked;
  while (!was_interrupted()) {
    const std::optional<MatchedFrame> frame = frames.next();
    if (!frame) break;
    Duration duration;
    const OdometryResult motion =
        timed(duration, [&] { return odometry.track(frame->pair, frame->disparity); });
    tracked.times.add("odometry", duration);
    ++tracked.frames;
    report_frame(*frame, motion, verbose);
    if (motion.status == OdometryStatus::lost)
      ++tracked.lost;
    else
      tracked.segments[motion.segment].push_back({frame->pair.stamp_ns, motion.T_segment_camera});
  }
  if (config.refine) {
    tracked.segments.clear();
    for (const PlacedFrame& frame : odometry.placed_frames())
      tracked.segments[frame.segment].push_back({frame.stamp_ns, frame.T_segment_camera});
  }
  return tracked;
}

ExitCode run(const OdometryOptions& options) {
  const PipelineConfig config = options.config.load(options.source.shorthands());
  for (const std::string& output : {options.output, options.kitti_output}) require_output(output);
  const std::unique_ptr<StereoSequence> sequence = options.source.open(config);
  for (const std::string& remark : sequence->info().remarks) warn(remark);
  cv::setNumThreads(std::max(1, config.thread_count() - 1));
  catch_interrupt();
  const Tracked tracked = track(*sequence, config, options.verbose);
  if (tracked.segments.empty()) throw Error(options.source.source + ": no frame was tracked");

  const auto& [id, trajectory] = *std::ranges::max_element(
      tracked.segments, {}, [](const auto& segment) { return segment.second.size(); });
  write_tum(options.output, trajectory,
            "left rectified camera (x right, y down, z forward) in the frame of its first pose");
  if (!options.kitti_output.empty()) write_kitti_poses(options.kitti_output, trajectory);
  std::cout << fmt::format(
      "{}: {} poses, {:.3f} m; {} of {} frames lost, {} segments; median {:.1f} ms a frame\n",
      options.output, trajectory.size(), path_length_m(trajectory), tracked.lost, tracked.frames,
      tracked.segments.size(), tracked.times.summary("odometry").median_ms);
  if (was_interrupted()) return ExitCode::interrupted;
  return 100.0 * (tracked.frames - tracked.lost) >= config.min_tracked_percent * tracked.frames
             ? ExitCode::ok
             : ExitCode::below_quality_gate;
}

}  // namespace

void add_odometry(CLI::App& program, Action& action) {
  auto options = std::make_shared<OdometryOptions>();
  CLI::App* command = program.add_subcommand("odometry", "camera motion of a stereo sequence");
  options->source.add_to(*command);
  options->config.add_to(*command);
  command->add_option("-o,--output", options->output, "TUM file; the segment with most poses")
      ->required()
      ->type_name("FILE");
  command->add_option("--kitti", options->kitti_output, "the same poses in KITTI's form")
      ->type_name("FILE");
  command->add_flag("-v,--verbose", options->verbose, "print a line for each frame");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
