#include "stereovox/pipeline/build_maps.h"

#include "stereovox/core/error.h"
#include "stereovox/pipeline/map_builder.h"
#include "stereovox/pipeline/matched_frames.h"

namespace stereovox {

BuildResult build_maps(StereoSequence& sequence, const PipelineConfig& config,
                       const std::optional<Trajectory>& given_poses, const ProgressSink& progress,
                       const std::filesystem::path& store_folder) {
  const Stopwatch watch;
  const Rectifier rectifier(sequence.rig(), config.rectification);
  MatchedFrames frames(sequence, rectifier, config);
  if (!frames.warning().empty()) progress.warn(frames.warning());

  MapBuilder builder(rectifier, config, given_poses, store_folder);
  bool was_stopped = false;
  std::string failure;
  int done = 0;
  while (!(was_stopped = progress.should_stop())) {
    std::optional<MatchedFrame> frame = frames.next();
    if (!frame) break;
    Progress state;
    try {
      state = builder.add(std::move(*frame));
    } catch (const ResourceError& error) {
      failure = error.what();
      break;
    }
    state.frame = ++done;
    state.frames = sequence.info().pairs;
    state.elapsed_s = watch.elapsed().wall_ms / 1e3;
    progress.frame_done(state);
  }

  BuildResult result = builder.finish();
  for (const std::string& warning : result.warnings) progress.warn(warning);
  result.failure = failure;
  if (!frames.warning().empty()) result.warnings.push_back(frames.warning());
  result.was_stopped = was_stopped;
  result.wall_s = watch.elapsed().wall_ms / 1e3;
  return result;
}

}  // namespace stereovox
