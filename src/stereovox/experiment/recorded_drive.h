// The stereo data that all methods of an experiment share: a simulated drive, its disparities and
// its poses, true and estimated. Made once and kept in a cache folder by content: what was made
// from the same world, drive, seed and parameters is found again.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/pipeline/pipeline_config.h"
#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {

struct RecordedPose {
  std::int64_t stamp_ns = 0;
  SE3 T_world_camera;                           // exact
  std::optional<SE3> T_world_camera_estimated;  // by odometry from the true first pose
};

struct RecordedDrive {
  std::shared_ptr<const Simulation> simulation;  // the world, as shifted by the seed
  RectifiedCamera camera;
  std::vector<RecordedPose> poses;  // one a frame
  std::filesystem::path folder;     // of the disparities

  DisparityImage disparity(int frame) const;
  std::string key;  // all that the data depend on, as text
};

struct RecordingRequest {
  std::string name;  // for people, in the folder's name
  std::filesystem::path world;
  std::string drive;
  SimulationParams simulation;
  PipelineConfig pipeline;  // rectification, matcher, odometry
  std::string build = {};   // of the program: another one may match and track differently
};

struct RecordingProgress {
  std::function<void(const std::string&)> say = [](const std::string&) {};
  std::function<bool()> should_stop = [] { return false; };
};

// Renders what is not in the cache yet; frames that an interrupted run rendered are kept. Nothing
// when it was stopped. Throws Error and ResourceError.
std::optional<RecordedDrive> record_drive(const std::filesystem::path& cache,
                                          const RecordingRequest& request, int threads,
                                          const RecordingProgress& progress);

// A short name for a text; equal texts have equal names.
std::string content_name(const std::string& text);

}  // namespace stereovox
