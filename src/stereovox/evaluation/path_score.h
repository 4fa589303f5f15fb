// What the errors of a map do to a robot that plans on it (method.md, B.5, PA-1): paths that the
// map promises and the world refuses, and paths that it withholds. All pairs of waypoints of a
// lattice over the ideal map's free space are joined, the same waypoints for every map.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "stereovox/evaluation/ideal_map.h"
#include "stereovox/navmap/plan_path.h"

namespace stereovox {

enum class PathRule {
  clearance,      // shortest_paths of navmap/plan_path.h: near to Voronoi paths, and always there
  breadth_first,  // fewest straight moves: simple enough to check by hand
};

struct PathScoreParams {
  double robot_radius_m = 0.22;
  PathRule rule = PathRule::clearance;
  double waypoint_pitch_m = 1.0;
  double waypoint_offset_m = 0.5;  // of the lattice from the ideal map's origin, along both axes
  double snap_m = 0.5;             // a waypoint moves this far at most to stand on a free cell
  int threads = 1;
};

struct PathCounts {
  std::int64_t ideal_pairs = 0, generated_pairs = 0;  // with a path in that map
  std::int64_t false_positives = 0;  // generated paths that touch an obstacle grown by the radius
  std::int64_t false_negatives = 0;  // pairs with an ideal path and no generated one
  std::int64_t strict_false_negatives =
      0;                          // ideal paths that touch what is not free when generated
  std::int64_t common_pairs = 0;  // with both paths, whose lengths are summed:
  double ideal_length_m = 0, generated_length_m = 0;

  // Absent when there is no path to be wrong.
  std::optional<double> false_positive_percent() const;
  std::optional<double> false_negative_percent() const;
  std::optional<double> strict_false_negative_percent() const;
  std::optional<double> length_ratio() const;  // generated to ideal
};

// A map that shows nothing promises nothing: read false positives beside false negatives.
struct PathScore {
  int waypoints = 0;
  PathCounts unknown_blocked;  // the headline: unknown cells of the generated map are no way
  PathCounts unknown_free;
};

PathScore score_paths(const IdealMap& ideal, const OccupancyGrid2D& generated,
                      const PathScoreParams& params);

// The waypoints of `ideal`, a planning_map: positions in the largest piece of its free cells that
// can hold the robot, ascending, none twice.
std::vector<int> waypoints_of(const OccupancyGrid2D& ideal, const PathScoreParams& params);

// The counts for given waypoints on maps of one geometry. The result does not depend on `threads`.
PathScore compare_paths(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated,
                        std::span<const int> waypoints, const PathScoreParams& params);

}  // namespace stereovox
