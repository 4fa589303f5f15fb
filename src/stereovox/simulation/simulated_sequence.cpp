#include "stereovox/simulation/simulated_sequence.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

DriveStyle style_of(const SimulationParams& params, const DrivePlan& plan) {
  return {.speed_m_s = params.speed_m_s > 0 ? params.speed_m_s : plan.speed_m_s,
          .turn_rate_rad_s = params.turn_rate_deg_s * std::numbers::pi / 180,
          .corner_radius_m = params.corner_radius_m,
          .jitter_m = params.jitter_m};
}

World shifted_by_seed(World world, const SimulationParams& params) {
  const auto part = [&](int axis) {
    return params.shift_m *
           (hash_of(axis, 0, 1, static_cast<std::uint32_t>(params.seed)) / 4294967295.0);
  };
  shift(world, {part(0), part(1)});
  return world;
}

Trajectory trajectory_of(const World& world, const std::string& drive,
                         const SimulationParams& params, const std::string& source) {
  const DrivePlan& plan = drive_of(world, drive, source);
  const auto seed = static_cast<std::uint32_t>(params.seed);
  const double rate_hz = params.rate_hz > 0 ? params.rate_hz : plan.rate_hz;
  const std::vector<PlanarPose> poses =
      sample(motions_of(plan, style_of(params, plan), seed), rate_hz);
  check_clearance(world, poses, {.radius_m = params.robot_radius_m}, drive, source);
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i)
    trajectory.push_back({std::llround(static_cast<double>(i) / rate_hz * kNanosecondsPerSecond),
                          camera_pose(poses[i], params.rig, static_cast<int>(i), seed)});
  return trajectory;
}

class SimulatedSequence : public StereoSequence {
 public:
  SimulatedSequence(std::shared_ptr<const Simulation> simulation, const SequenceParams& params,
                    const std::filesystem::path& source)
      : simulation_(std::move(simulation)), step_(params.frame_skip + 1) {
    const Trajectory& all = simulation_->trajectory();
    while (first_ < all.size() && seconds(first_) < params.start_s) ++first_;
    end_ = first_;
    while (end_ < all.size() &&
           (params.duration_s <= 0 || seconds(end_) <= params.start_s + params.duration_s))
      ++end_;
    info_.pairs = static_cast<int>((end_ - first_ + step_ - 1) / step_);
    if (params.max_frames > 0) info_.pairs = std::min(info_.pairs, params.max_frames);
    if (info_.pairs == 0)
      throw UsageError(fmt::format("{}: no frame is left, the drive takes {:.1f} s",
                                   source.string(), seconds(all.size() - 1)));
    info_.layout = "simulated";
    info_.path = source;
  }

  const StereoRig& rig() const override { return simulation_->rig(); }
  const SequenceInfo& info() const override { return info_; }
  const Trajectory& truth() const override { return simulation_->trajectory(); }
  std::span<const SkippedPair> skipped() const override { return {}; }
  std::optional<StereoFrame> next() override {
    if (delivered_ == info_.pairs) return std::nullopt;
    return simulation_->frame(
        static_cast<int>(first_ + step_ * static_cast<std::size_t>(delivered_++)));
  }

 private:
  double seconds(std::size_t i) const {
    return static_cast<double>(simulation_->trajectory()[i].stamp_ns) / kNanosecondsPerSecond;
  }

  std::shared_ptr<const Simulation> simulation_;
  SequenceInfo info_;
  std::size_t first_ = 0, end_ = 0, step_ = 1;
  int delivered_ = 0;
};

}  // namespace

void SimulationParams::describe(ParameterList& list) {
  list("seed", seed, {0, 1e9}, "of the noise, the shaking and the jitter");
  list("speed_m_s", speed_m_s, {0, 10}, "of the robot, 0 = as the drive says");
  list("rate_hz", rate_hz, {0, 1000}, "pairs a second, 0 = as the drive says");
  list("turn_rate_deg_s", turn_rate_deg_s, {1, 360}, "fastest turn");
  list("corner_radius_m", corner_radius_m, {0, 10}, "of the arcs between straight pieces");
  list("jitter_m", jitter_m, {0, 1}, "each way-point is moved by up to so much, by the seed");
  list("shift_m", shift_m, {0, 100},
       "the world is moved by up to so much along x and y, by the seed: against the map's cells");
  list("robot_radius_m", robot_radius_m, {0, 5}, "a drive that comes nearer to a solid is refused");
  list.section("rig", rig);
  list.section("sensor", sensor);
}

Simulation::Simulation(World world, const std::string& drive, const SimulationParams& params,
                       const std::string& source, int threads)
    : world_(shifted_by_seed(std::move(world), params)),
      params_(params),
      rig_(rig_of(params.rig)),
      left_rays_(rig_.left),
      right_rays_(rig_.right),
      trajectory_(trajectory_of(world_, drive, params, source)),
      threads_(threads) {
  validate(rig_, source);
  if (world_.people.empty()) still_scene_ = std::make_shared<Scene>(world_, 0.0);
}

double Simulation::time_s(int index) const {
  return static_cast<double>(trajectory_.at(static_cast<std::size_t>(index)).stamp_ns) /
         kNanosecondsPerSecond;
}

std::shared_ptr<const Scene> Simulation::scene_at(int index) const {
  return still_scene_ ? still_scene_ : std::make_shared<Scene>(world_, time_s(index));
}

StereoFrame Simulation::frame(int index) const {
  const StampedPose& pose = trajectory_.at(static_cast<std::size_t>(index));
  const SE3 T_world_right = pose.T_world_camera * inverse(rig_.T_right_left);
  const std::shared_ptr<const Scene> scene = scene_at(index);
  const cv::Mat1f left = render(world_, *scene, left_rays_, pose.T_world_camera, threads_);
  const cv::Mat1f right = render(world_, *scene, right_rays_, T_world_right, threads_);
  const double exposure = exposure_of(left, params_.sensor);
  const auto noise = [&](int camera) {
    return hash_of(index, camera, 0, static_cast<std::uint32_t>(params_.seed));
  };
  return {.stamp_ns = pose.stamp_ns,
          .index = index,
          .name = fmt::format("frame {}", index),
          .left = expose(left, exposure, params_.sensor, noise(0), threads_),
          .right = expose(right, exposure * (1 + params_.sensor.gain_difference), params_.sensor,
                          noise(1), threads_)};
}

Simulation::Truth Simulation::truth(int index) const {
  const SE3& T_world_left = trajectory_.at(static_cast<std::size_t>(index)).T_world_camera;
  const std::shared_ptr<const Scene> scene = scene_at(index);
  Truth truth{depth_of(*scene, left_rays_, T_world_left, threads_), {}, {}};
  if (!rig_.is_rectified) return truth;
  const double fb = rig_.left.pinhole.fx_px * rig_.baseline_m();
  truth.disparity_px = cv::Mat1f(truth.depth_m.size());
  for (int v = 0; v < truth.depth_m.rows; ++v)
    for (int u = 0; u < truth.depth_m.cols; ++u)
      truth.disparity_px(v, u) =
          truth.depth_m(v, u) > 0 ? static_cast<float>(fb / truth.depth_m(v, u)) : 0.0F;
  truth.occluded = occluded_pixels(*scene, left_rays_, truth.depth_m, T_world_left,
                                   {rig_.right.pinhole, rig_.baseline_m()}, threads_);
  return truth;
}

std::unique_ptr<StereoSequence> simulated_sequence(std::shared_ptr<const Simulation> simulation,
                                                   const SequenceParams& params,
                                                   const std::filesystem::path& source) {
  return std::make_unique<SimulatedSequence>(std::move(simulation), params, source);
}

}  // namespace stereovox
