#include "stereovox/experiment/map_drive.h"

#include <fmt/format.h>

#include <algorithm>

#include <cmath>
#include <nlohmann/json.hpp>

#include "stereovox/evaluation/map_score_report.h"
#include "stereovox/evaluation/visible_cells.h"
#include "stereovox/evaluation/voxel_score.h"
#include "stereovox/experiment/ideal_maps.h"
#include "stereovox/experiment/method_run.h"
#include "stereovox/io/image_file.h"
#include "stereovox/navmap/draw_voxels.h"
#include "stereovox/navmap/write_map_server.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// Around the plan, so that obstacles invented outside of it count.
constexpr double kMargin_m = 0.5;

struct CaseRun {
  MapCase of;
  MethodRun run;
};

std::vector<CaseRun> runs_of(const ExperimentConfig& config, const DriveCase& drive,
                             PoseSource poses) {
  std::vector<CaseRun> runs;
  for (const MethodGroup& group : config.groups) {
    if (std::ranges::find(group.seeds, drive.seed) == group.seeds.end()) continue;
    if (std::ranges::find(group.pose_sources, poses) == group.pose_sources.end()) continue;
    for (const double cell_size_m : group.cell_sizes_m)
      for (const NamedMethod& method : group.methods)
        runs.push_back({{group.title, drive.world, method.name, drive.seed, poses, cell_size_m},
                        MethodRun(method.method, cell_size_m, config.band)});
  }
  return runs;
}

std::optional<SE3> pose_of(const RecordedPose& pose, PoseSource source) {
  return source == PoseSource::truth ? std::optional(pose.T_world_camera)
                                     : pose.T_world_camera_estimated;
}

GridGeometry with_margin(GridGeometry geometry) {
  const int cells = static_cast<int>(std::ceil(kMargin_m / geometry.cell_size_m));
  geometry.origin_m -= Eigen::Vector2d::Constant(cells * geometry.cell_size_m);
  geometry.width += 2 * cells;
  geometry.height += 2 * cells;
  return geometry;
}

double heading_rad(const SE3& T_world_camera) {
  const Eigen::Vector3d forward = T_world_camera.rotation * Eigen::Vector3d::UnitZ();
  return std::atan2(forward.y(), forward.x());
}

// What a map is compared with.
struct Ideal {
  IdealMap map;
  MapScoreInput input;
};

class DriveMapper {
 public:
  DriveMapper(const ExperimentConfig& config, const RecordedDrive& drive, const DriveCase& of,
              const fs::path& maps, const RecordingProgress& progress)
      : config_(config), drive_(drive), of_(of), maps_(maps), progress_(progress) {}

  std::optional<std::vector<ResultRow>> run() {
    for (const PoseSource poses : {PoseSource::truth, PoseSource::estimated}) {
      std::vector<CaseRun> runs = runs_of(config_, of_, poses);
      if (runs.empty()) continue;
      if (!add_frames(poses, runs)) return std::nullopt;
      progress_.say(fmt::format("mapped with {} poses by {} methods",
                                names_of(poses)[static_cast<std::size_t>(poses)], runs.size()));
      for (const CaseRun& r : runs) {
        if (progress_.should_stop()) return std::nullopt;
        finish(r);
      }
      scans_.clear();
    }
    return std::move(rows_);
  }

 private:
  bool add_frames(PoseSource poses, std::vector<CaseRun>& runs) {
    const bool wants_scans =
        std::ranges::any_of(runs, [](const CaseRun& r) { return r.run.needs_scans(); });
    for (int i = 0; i < static_cast<int>(drive_.poses.size()); ++i) {
      if (progress_.should_stop()) return false;
      const RecordedPose& recorded = drive_.poses[static_cast<std::size_t>(i)];
      const std::optional<SE3> pose = pose_of(recorded, poses);
      if (!pose) continue;
      const DisparityImage disparity = drive_.disparity(i);
      const MethodFrame frame{disparity, drive_.camera, *pose, recorded.stamp_ns};
      for (CaseRun& r : runs) r.run.add(frame);
      if (wants_scans)
        scans_.push_back(
            pseudo_scan(disparity, drive_.camera, *pose, 0.0, recorded.stamp_ns, config_.scan));
    }
    return true;
  }

  const Ideal& ideal_of(double cell_size_m) {
    const auto found = ideals_.find(cell_size_m);
    if (found != ideals_.end()) return found->second;
    const World& world = drive_.simulation->world();
    const IdealMap plan = ideal_map(world, cell_size_m, config_.band,
                                    drive_.poses.front().T_world_camera.translation.head<2>());
    Ideal ideal{extended_to(plan, with_margin(plan.normalised.geometry)), {}};
    ideal.input.doorways = doorways_of(world);
    std::vector<ViewPose> views;
    for (const RecordedPose& pose : drive_.poses)
      views.push_back(
          {pose.T_world_camera.translation.head<2>(), heading_rad(pose.T_world_camera)});
    const PinholeCamera& camera = drive_.camera.pinhole;
    ideal.input.visible =
        visible_cells(ideal.map.normalised, views, 2 * std::atan2(camera.width, 2 * camera.fx_px),
                      config_.visible_range_m);
    write_map_server(maps_ / (ideal_file_name(of_, cell_size_m) + ".yaml"), ideal.map.normalised,
                     MapServerMode::trinary);
    write_map_server(maps_ / (ideal_file_name(of_, cell_size_m) + "_theoretical.yaml"),
                     ideal.map.theoretical, MapServerMode::trinary);
    return ideals_.emplace(cell_size_m, std::move(ideal)).first->second;
  }

  void finish(const CaseRun& r) {
    const Ideal& ideal = ideal_of(r.of.cell_size_m);
    const OccupancyGrid2D map = r.run.map(scans_, ideal.map.normalised.geometry);
    write_map_server(maps_ / (file_name(r.of) + ".yaml"), map, MapServerMode::trinary);
    ResultRow row{r.of, {}};
    const MapScore score = score_map(ideal.map, map, config_.score, ideal.input);
    for (const ScoreRow& figure : map_score_rows())
      if (const std::optional<double> value = figure.value(score)) row.values[figure.key] = *value;
    row.values["map_ms_per_frame"] = r.run.map_ms() / static_cast<double>(drive_.poses.size());
    if (r.run.voxels() != nullptr) finish_voxels(*r.run.voxels(), r.of, row);
    rows_.push_back(std::move(row));
  }

  void finish_voxels(const VoxelMap& voxels, const MapCase& of, ResultRow& row) {
    if (of.group != config_.groups.front().title) return;
    const auto [ideal, is_new] = ideal_voxels_.try_emplace(of.cell_size_m, of.cell_size_m);
    if (is_new) ideal->second = ideal_voxel_map(drive_.simulation->world(), of.cell_size_m);
    const nlohmann::json figures = to_json(score_voxels(ideal->second, voxels, {}));
    for (const auto& [key, value] : figures.items())
      if (value.is_number()) row.values["voxels_" + key] = value.get<double>();
    if (of.seed == config_.seeds().front())
      write_png(maps_ / (file_name(of) + "_voxels.png"), draw_voxels(voxels));
  }

  const ExperimentConfig& config_;
  const RecordedDrive& drive_;
  const DriveCase of_;
  const fs::path maps_;
  const RecordingProgress& progress_;
  std::vector<PseudoScan> scans_;
  std::map<double, Ideal> ideals_;
  std::map<double, VoxelMap> ideal_voxels_;
  std::vector<ResultRow> rows_;
};

std::string as_file_name(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return text;
}

int centimetres(double length_m) { return static_cast<int>(std::lround(100 * length_m)); }

}  // namespace

std::string file_name(const MapCase& of) {
  return fmt::format("{}_s{}_{}_{:03d}cm_{}_{}", as_file_name(of.world), of.seed,
                     names_of(of.poses)[static_cast<std::size_t>(of.poses)],
                     centimetres(of.cell_size_m), as_file_name(of.group), as_file_name(of.method));
}

std::string ideal_file_name(const DriveCase& of, double cell_size_m) {
  return fmt::format("{}_s{}_ideal_{:03d}cm", as_file_name(of.world), of.seed,
                     centimetres(cell_size_m));
}

std::optional<std::vector<ResultRow>> map_drive(const ExperimentConfig& config,
                                                const RecordedDrive& drive, const DriveCase& of,
                                                const fs::path& maps,
                                                const RecordingProgress& progress) {
  return DriveMapper(config, drive, of, maps, progress).run();
}

}  // namespace stereovox
