#include "stereovox/pipeline/report.h"

#include <sys/resource.h>

#include <Eigen/Core>

#include "stereovox/core/timestamp.h"
#include "stereovox/core/version.h"

namespace stereovox {
namespace {

using nlohmann::ordered_json;

ordered_json stages_json(const StageTimes& times) {
  ordered_json stages;
  for (const char* stage : kStages) {
    const StageSummary s = times.summary(stage);
    stages[stage] = {{"median_ms", s.median_ms}, {"p95_ms", s.p95_ms}, {"cpu_ms", s.cpu_ms}};
  }
  return stages;
}

ordered_json lost_json(const std::vector<LostStretch>& lost) {
  ordered_json list = ordered_json::array();
  for (const LostStretch& stretch : lost)
    list.push_back({{"from_s", seconds_from_ns(stretch.from_ns)},
                    {"to_s", seconds_from_ns(stretch.to_ns)},
                    {"frames", stretch.frames},
                    {"reason", stretch.reason}});
  return list;
}

ordered_json skipped_json(std::span<const SkippedPair> skipped) {
  ordered_json list = ordered_json::array();
  for (const SkippedPair& pair : skipped)
    list.push_back({{"name", pair.name}, {"reason", pair.reason}});
  return list;
}

ordered_json map_json(const VoxelMap& map, double threshold) {
  const MapCounts counts = count_voxels(map, threshold);
  const auto [lowest_floor_m, highest_floor_m] = map.floor.z_range_m();
  return {{"voxel_size_m", map.voxel_size_m()},
          {"floor_z_m", map.floor_z_m()},
          {"lowest_floor_z_m", lowest_floor_m},
          {"highest_floor_z_m", highest_floor_m},
          {"observed", counts.observed},
          {"occupied", counts.occupied},
          {"free", counts.free},
          {"bytes", map.memory_bytes()}};
}

ordered_json segments_json(const std::vector<MapSegment>& segments) {
  ordered_json list = ordered_json::array();
  for (const MapSegment& segment : segments)
    list.push_back({{"id", segment.id},
                    {"frames", segment.trajectory.size()},
                    {"path_length_m", path_length_m(segment.trajectory)},
                    {"world", segment.world.source}});
  return list;
}

ordered_json source_json(const StereoSequence& sequence) {
  const SequenceInfo& info = sequence.info();
  return {{"layout", info.layout},         {"pairs", info.pairs},
          {"left_only", info.left_only},   {"right_only", info.right_only},
          {"duplicates", info.duplicates}, {"gaps", info.gaps},
          {"remarks", info.remarks}};
}

ordered_json camera_json(const RectifiedCamera& camera) {
  const PinholeCamera& c = camera.pinhole;
  return {{"width", c.width},
          {"height", c.height},
          {"fx_px", c.fx_px},
          {"fy_px", c.fy_px},
          {"cx_px", c.cx_px},
          {"cy_px", c.cy_px},
          {"baseline_m", camera.baseline_m}};
}

}  // namespace

MapCounts count_voxels(const VoxelMap& map, double threshold) {
  MapCounts counts;
  map.for_each_block([&](const VoxelBlock& block) {
    for (const Voxel voxel : block.voxels) {
      if (!is_known(voxel)) continue;
      ++counts.observed;
      ++(voxel.state > threshold ? counts.occupied : counts.free);
    }
  });
  return counts;
}

ordered_json report(const StereoSequence& sequence, const PipelineConfig& config,
                    const BuildResult& result) {
  const MapSegment& main = result.segments.front();
  return {{"version", version()},
          {"source", source_json(sequence)},
          {"camera", camera_json(result.camera)},
          {"frames", result.frames},
          {"tracked", result.tracked},
          {"repeated", result.repeated},
          {"lost_segments", lost_json(result.lost)},
          {"segments", segments_json(result.segments)},
          {"skipped", skipped_json(sequence.skipped())},
          {"warnings", result.warnings},
          {"stopped_early", result.was_stopped || !result.failure.empty()},
          {"wall_s", result.wall_s},
          {"fps", result.wall_s > 0.0 ? result.frames / result.wall_s : 0.0},
          {"threads", config.thread_count()},
          {"peak_rss_bytes", peak_rss_bytes()},
          {"stages", stages_json(result.times)},
          {"map", map_json(main.map, config.navmap.threshold)}};
}

std::size_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace stereovox
