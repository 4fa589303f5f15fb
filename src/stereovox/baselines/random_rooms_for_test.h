// Random rooms with boxes, and what a perfect planar range finder with some noise reads in them.
#pragma once

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include "stereovox/baselines/beam_cells.h"
#include "stereovox/baselines/pseudo_scan.h"
#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

using RandomEngine = std::mt19937_64;

inline double random_between(RandomEngine& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline void fill_cells(OccupancyGrid2D& grid, const Eigen::Vector2i& first,
                       const Eigen::Vector2i& last, CellLabel label) {
  for (int y = std::max(0, first.y()); y <= std::min(last.y(), grid.geometry.height - 1); ++y)
    for (int x = std::max(0, first.x()); x <= std::min(last.x(), grid.geometry.width - 1); ++x)
      grid.labels[grid.position_of({x, y})] = label;
}

// Walls one cell thick around free floor on which boxes stand.
inline OccupancyGrid2D random_room(RandomEngine& random, double cell_size_m) {
  const auto cells = [&](double low_m, double high_m) {
    return static_cast<int>(random_between(random, low_m, high_m) / cell_size_m);
  };
  const int width = cells(5, 11), height = cells(5, 11);
  OccupancyGrid2D room = unknown_grid({{0, 0}, cell_size_m, width, height}, "room");
  fill_cells(room, {0, 0}, {width - 1, height - 1}, CellLabel::occupied);
  fill_cells(room, {1, 1}, {width - 2, height - 2}, CellLabel::free);
  const int boxes = std::uniform_int_distribution<int>(2, 7)(random);
  for (int i = 0; i < boxes; ++i) {
    const Eigen::Vector2i first(cells(0.5, width * cell_size_m), cells(0.5, height * cell_size_m));
    fill_cells(room, first, first + Eigen::Vector2i(cells(0, 1.5), cells(0, 1.5)),
               CellLabel::occupied);
  }
  return room;
}

// Distance to where the ray enters an occupied cell; `length_m` when it meets none before.
inline double distance_to_occupied(const OccupancyGrid2D& room, const Ray2D& ray, double length_m) {
  double distance_m = length_m;
  for_each_beam_cell(room.geometry, ray, length_m, [&](const BeamCell& cell) {
    if (room.labels[cell.position] == CellLabel::occupied)
      distance_m = std::min(distance_m, cell.enter_m);
  });
  return distance_m;
}

struct RangeFinder {
  int beams = 125;
  double width_rad = 0.5 * std::numbers::pi / 180.0;  // of a beam
  double max_range_m = 5.0;
  double sigma_at_1_m = 0.25 / 63.0;  // a quarter of a pixel at 525 px and 0.12 m
  double missing = 0.05;              // share of beams without any reading
};

inline PseudoScan scan_in(const OccupancyGrid2D& room, const Eigen::Vector2d& position_m,
                          double heading_rad, RandomEngine& random,
                          const RangeFinder& finder = {}) {
  PseudoScan scan{0, position_m, heading_rad, {}};
  for (int i = 0; i < finder.beams; ++i) {
    Beam beam{.bearing_rad = (i - 0.5 * (finder.beams - 1)) * finder.width_rad};
    const double range_m = distance_to_occupied(room, {position_m, heading_rad + beam.bearing_rad},
                                                2.0 * finder.max_range_m);
    beam.sigma_m = std::max(0.01, finder.sigma_at_1_m * range_m * range_m);
    const double noise = std::normal_distribution<double>()(random);
    const bool is_missing = random_between(random, 0, 1) < finder.missing;
    beam.has_range = !is_missing && range_m <= finder.max_range_m;
    if (beam.has_range) beam.range_m = std::max(0.05, range_m + beam.sigma_m * noise);
    if (!is_missing && !beam.has_range) beam.free_range_m = finder.max_range_m;
    scan.beams.push_back(beam);
  }
  return scan;
}

inline Eigen::Vector2d random_free_position(const OccupancyGrid2D& room, RandomEngine& random) {
  for (;;) {
    const Eigen::Vector2d p(
        random_between(random, 0, room.geometry.width * room.geometry.cell_size_m),
        random_between(random, 0, room.geometry.height * room.geometry.cell_size_m));
    if (room.label_at(index_of(room.geometry, p)) == CellLabel::free) return p;
  }
}

inline std::vector<PseudoScan> random_scans(const OccupancyGrid2D& room, int count,
                                            RandomEngine& random, const RangeFinder& finder = {}) {
  std::vector<PseudoScan> scans;
  for (int i = 0; i < count; ++i)
    scans.push_back(scan_in(room, random_free_position(room, random),
                            random_between(random, -std::numbers::pi, std::numbers::pi), random,
                            finder));
  return scans;
}

}  // namespace stereovox
