#include "stereovox/evaluation/map_score.h"

#include "stereovox/evaluation/image_similarity.h"

namespace stereovox {
namespace {

std::vector<JudgedCell> judged_cells(const OccupancyGrid2D& normalised,
                                     const OccupancyGrid2D& generated, const ValueGrid& values,
                                     bool only_known) {
  std::vector<JudgedCell> cells;
  for (std::size_t i = 0; i < values.values.size(); ++i) {
    if (normalised.labels[i] == CellLabel::unknown) continue;
    if (only_known && generated.labels[i] == CellLabel::unknown) continue;
    cells.push_back({values.values[i], normalised.labels[i] == CellLabel::occupied});
  }
  return cells;
}

ValueScore score_values(const IdealMap& ideal, const OccupancyGrid2D& generated, MapForm form,
                        int max_shift_cells) {
  const ValueGrid theoretical = value_grid(ideal.theoretical, MapForm::ternary);
  const ValueGrid normalised = value_grid(ideal.normalised, MapForm::ternary);
  const ValueGrid values = value_grid(generated, form);
  const auto judged = [&](bool only_known) {
    return score_calibration(judged_cells(ideal.normalised, generated, values, only_known));
  };
  return {.correlation = correlation(theoretical, values),
          .best_shift = best_shift(theoretical, values, max_shift_cells),
          .all = error_over_all(normalised, values),
          .occupied = error_over_occupied(normalised, values),
          .match_bits = match_bits(normalised, values),
          .ssim = structural_similarity(normalised, values),
          .judged = judged(false),
          .known = judged(true)};
}

// All maps are of one geometry.
CellScore score_cells(const IdealMap& ideal, const OccupancyGrid2D& generated,
                      int max_shift_cells) {
  return {.ternary = score_values(ideal, generated, MapForm::ternary, max_shift_cells),
          .graded = score_values(ideal, generated, MapForm::graded, max_shift_cells),
          .classes = score_classes(ideal.normalised, generated),
          .obstacles = score_obstacle_distance(ideal, generated)};
}

PathScoreParams path_params(const MapScoreParams& params, int threads) {
  return {.robot_radius_m = params.robot_radius_m,
          .waypoint_pitch_m = params.waypoint_pitch_m,
          .waypoint_offset_m = params.waypoint_offset_m,
          .snap_m = params.snap_m,
          .threads = threads};
}

VoronoiScoreParams voronoi_params(const MapScoreParams& params, int threads) {
  return {.robot_radius_m = params.robot_radius_m,
          .max_pairs = params.voronoi_pairs,
          .seed = static_cast<std::uint64_t>(params.seed),
          .threads = threads};
}

}  // namespace

void MapScoreParams::describe(ParameterList& list) {
  list("robot_radius_m", robot_radius_m, {0.0, 10.0}, "of the robot that drives by the map");
  list("waypoint_pitch_m", waypoint_pitch_m, {0.05, 100.0},
       "distance of the places between which paths are planned");
  list("waypoint_offset_m", waypoint_offset_m, {0.0, 100.0},
       "of the first such place from the ideal map's origin, along both axes");
  list("snap_m", snap_m, {0.0, 10.0}, "such a place moves this far at most to a free cell");
  list("max_shift_cells", max_shift_cells, {0, 20}, "of the best correlation");
  list("voronoi_pairs", voronoi_pairs, {1, 1000000}, "at most so many paths on Voronoi lines");
  list("seed", seed, {0, 1000000}, "of the choice of these paths");
}

MapScore score_map(const IdealMap& ideal, const OccupancyGrid2D& generated,
                   const MapScoreParams& params, const MapScoreInput& input, int threads) {
  MapScore score;
  score.region = union_of(ideal.theoretical.geometry, generated.geometry);
  const IdealMap wide_ideal = extended_to(ideal, score.region);
  const OccupancyGrid2D map = extended_to(generated, score.region);
  score.cells = score_cells(wide_ideal, map, params.max_shift_cells);
  if (input.visible)
    score.visible_cells =
        score_cells(extended_to(restricted_to(ideal, *input.visible), score.region), map,
                    params.max_shift_cells);
  score.free_space = topology_of(cells_labelled(map, CellLabel::free));
  score.ideal_free_space = topology_of(cells_labelled(wide_ideal.normalised, CellLabel::free));
  score.paths = score_paths(ideal, generated, path_params(params, threads));
  score.voronoi = score_voronoi_paths(ideal, generated, voronoi_params(params, threads));
  if (!input.doorways.empty())
    score.doors = score_doors(input.doorways, planning_map(wide_ideal), map, params.robot_radius_m);
  return score;
}

AlignedMap aligned_to(const IdealMap& ideal, const OccupancyGrid2D& generated, double max_shift_m) {
  const double cell_size_m = ideal.theoretical.geometry.cell_size_m;
  const BestShift best = best_shift(value_grid(ideal.theoretical, MapForm::ternary),
                                    value_grid(generated, MapForm::ternary),
                                    static_cast<int>(max_shift_m / cell_size_m));
  AlignedMap aligned{generated, best.shift_cells.cast<double>() * cell_size_m};
  aligned.map.geometry.origin_m += aligned.shift_m;
  return aligned;
}

}  // namespace stereovox
