// One mapping method at work on a recorded drive.
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/experiment/experiment_config.h"
#include "stereovox/navmap/sight_lines.h"
#include "stereovox/navmap/wall_faces.h"
#include "stereovox/occupancy/voxel_map.h"

namespace stereovox {

// What every method is given of a frame.
struct MethodFrame {
  const DisparityImage& disparity;
  const RectifiedCamera& camera;
  SE3 T_world_camera;
  std::int64_t stamp_ns;
};

// The maps cover the height band and cell size of the experiment, whatever the method's own say.
class MethodRun {
 public:
  MethodRun(const MappingMethod& method, double cell_size_m, const HeightBand& band);

  void add(const MethodFrame& frame);
  // `scans` are those of all frames so far, which methods on pseudo-scans map at once.
  OccupancyGrid2D map(std::span<const PseudoScan> scans, const GridGeometry& geometry) const;

  bool needs_scans() const;
  const VoxelMap* voxels() const;            // of the methods that have any
  double map_ms() const { return map_ms_; }  // time spent in add() and map()

 private:
  struct Voxels {
    OccupancyMethod method;
    VoxelMap map;
    SightLines sight_lines;
    WallFaces wall_faces;
  };
  struct Scans {
    Paradigm paradigm;
  };
  std::variant<Voxels, OctomapBaseline, Scans> state_;
  mutable double map_ms_ = 0.0;

  static std::variant<Voxels, OctomapBaseline, Scans> start(const MappingMethod& method,
                                                            double cell_size_m,
                                                            const HeightBand& band);
};

}  // namespace stereovox
