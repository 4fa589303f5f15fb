// How right a navigation map is: every figure of the map benchmark (method.md, section B) at once.
//
//   const IdealMap ideal = make_ideal(plan, start_m);
//   const MapScore score = score_map(ideal, map, {});
//   std::cout << to_text(score);              // map_score_report.h
#pragma once

#include <optional>
#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/evaluation/calibration.h"
#include "stereovox/evaluation/cell_classes.h"
#include "stereovox/evaluation/correlation.h"
#include "stereovox/evaluation/doorways.h"
#include "stereovox/evaluation/obstacle_distance.h"
#include "stereovox/evaluation/path_score.h"
#include "stereovox/evaluation/squared_error.h"
#include "stereovox/evaluation/topology.h"
#include "stereovox/evaluation/voronoi_score.h"

namespace stereovox {

struct MapScoreParams {
  double robot_radius_m = 0.22;
  double waypoint_pitch_m = 1.0;
  double waypoint_offset_m = 0.5;
  double snap_m = 0.5;
  int max_shift_cells = 2;  // of the diagnostic correlation
  int voronoi_pairs = 5000;
  int seed = 1;

  void describe(ParameterList& list);
};

// Figures of cell values, in one form of the map. All but the correlations compare with N.
struct ValueScore {
  Correlation correlation;  // with T
  BestShift best_shift;     // with T
  MapError all, occupied;
  MatchBits match_bits;
  std::optional<double> ssim;
  Calibration judged;  // over the cells where N is known; unknown cells say 0.5
  Calibration known;   // over those of them that the map knows
};

// Figures of single cells.
struct CellScore {
  ValueScore ternary, graded;
  CellClasses classes;
  ObstacleDistance obstacles;
};

struct MapScore {
  GridGeometry region;  // the union of both extents
  CellScore cells;
  std::optional<CellScore> visible_cells;  // against N_vis, when it was told what was in view
  Topology free_space, ideal_free_space;
  PathScore paths;
  VoronoiScore voronoi;
  std::optional<DoorScore> doors;
};

struct MapScoreInput {
  std::optional<CellMask> visible = {};  // of the geometry of the ideal map
  std::vector<Doorway> doorways = {};
};

// Throws Error as union_of. The result does not depend on `threads`.
MapScore score_map(const IdealMap& ideal, const OccupancyGrid2D& generated,
                   const MapScoreParams& params, const MapScoreInput& input = {}, int threads = 1);

// The map moved by whole cells, at most `max_shift_m` along each axis, to where it correlates best
// with T. A turned map is not turned back. Throws Error as union_of.
struct AlignedMap {
  OccupancyGrid2D map;
  Eigen::Vector2d shift_m = {0, 0};
};
AlignedMap aligned_to(const IdealMap& ideal, const OccupancyGrid2D& generated, double max_shift_m);

}  // namespace stereovox
