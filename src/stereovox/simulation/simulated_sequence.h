// A drive through a described world as a recording: each frame is rendered when it is asked for.
#pragma once

#include <filesystem>
#include <memory>

#include "stereovox/dataset/stereo_sequence.h"
#include "stereovox/simulation/render.h"
#include "stereovox/simulation/rig.h"
#include "stereovox/simulation/sensor.h"
#include "stereovox/simulation/world.h"

namespace stereovox {

struct SimulationParams {
  int seed = 1;
  double speed_m_s = 0.0, rate_hz = 0.0;
  double turn_rate_deg_s = 30.0;
  double corner_radius_m = 0.4;
  double jitter_m = 0.05, shift_m = 0.0;
  double robot_radius_m = 0.2;
  RigParams rig;
  SensorParams sensor;

  void describe(ParameterList& list);
};

// Everything that a frame of a drive depends on. The same parameters give the same images.
class Simulation {
 public:
  // `source` names the world in messages. Throws Error when the drive is missing or touches a
  // solid.
  Simulation(World world, const std::string& drive, const SimulationParams& params,
             const std::string& source, int threads);

  const World& world() const { return world_; }  // as shifted by the seed
  const StereoRig& rig() const { return rig_; }
  const Trajectory& trajectory() const { return trajectory_; }  // of the left camera

  StereoFrame frame(int index) const;

  // Exact, of the left camera as calibrated. Disparity and hidden pixels only of a rectified rig.
  struct Truth {
    cv::Mat1f depth_m;       // 0 = nothing there
    cv::Mat1f disparity_px;  // empty when the rig is not rectified
    cv::Mat1b occluded;      // 255 = the right camera does not see it; empty likewise
  };
  Truth truth(int index) const;

 private:
  std::shared_ptr<const Scene> scene_at(int index) const;
  double time_s(int index) const;

  World world_;
  SimulationParams params_;
  StereoRig rig_;
  PixelRays left_rays_, right_rays_;
  Trajectory trajectory_;
  std::shared_ptr<const Scene> still_scene_;  // of a world without people, shared by all frames
  int threads_;
};

// The drive as a sequence; `params` choose a part of it as they do of a recording.
std::unique_ptr<StereoSequence> simulated_sequence(std::shared_ptr<const Simulation> simulation,
                                                   const SequenceParams& params,
                                                   const std::filesystem::path& source);

}  // namespace stereovox
