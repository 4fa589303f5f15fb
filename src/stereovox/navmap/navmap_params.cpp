#include "stereovox/navmap/navmap_params.h"

#include <fmt/format.h>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

// What a neutral voxel falls to when about ten frames see it free. The far side of a wall, where
// the points' error leaves faint evidence, stays above.
constexpr double kTunedFreeThreshold = 0.25;
constexpr int kTunedMinObservations = 2;
constexpr double kTunedWallContrast = 0.1;
constexpr double kTunedMinReach = 0.1;

}  // namespace

std::span<const std::string> names_of(NavmapPreset) {
  static const std::vector<std::string> names = {"literal", "corrected", "tuned"};
  return names;
}

std::span<const std::string> names_of(ColumnRule) {
  static const std::vector<std::string> names = {"whole", "band"};
  return names;
}

std::span<const std::string> names_of(LabelRule) {
  static const std::vector<std::string> names = {"as_printed", "visible"};
  return names;
}

std::span<const std::string> names_of(HiddenCells) {
  static const std::vector<std::string> names = {"keep", "unknown"};
  return names;
}

void NavmapParams::describe(ParameterList& list) {
  list.preset(
      "preset", preset, "the paper as printed, as corrected, or tuned", [this](NavmapPreset p) {
        const bool literal = p == NavmapPreset::literal, tuned = p == NavmapPreset::tuned;
        const NavmapParams corrected;
        preset = p;
        column = literal ? ColumnRule::whole : ColumnRule::band;
        min_observations = literal ? 1 : tuned ? kTunedMinObservations : corrected.min_observations;
        free_threshold = tuned ? kTunedFreeThreshold : corrected.free_threshold;
        label_rule = literal ? LabelRule::as_printed : LabelRule::visible;
        wall_contrast = tuned ? kTunedWallContrast : corrected.wall_contrast;
        min_reach = tuned ? kTunedMinReach : corrected.min_reach;
        hidden_cells = tuned ? HiddenCells::unknown : HiddenCells::keep;
      });
  list("column", column, "which voxels above a cell count: all, or those in the height band");
  list("min_height_m", min_height_m, {-10, 100}, "lower end of the band, above the floor");
  list("max_height_m", max_height_m, {-10, 100}, "upper end of the band, above the floor");
  list("min_observations", min_observations, {1, 1000},
       "voxels observed in fewer frames do not count");
  list("threshold", threshold, {0, 1}, "a cell is occupied when its state is above this");
  list("free_threshold", free_threshold, {0, 1},
       "a cell is seen free when its state is below this; less leaves faint obstacles unknown");
  list("hysteresis", hysteresis, {0, 1},
       "an occupied cell stays so until its state is below threshold by this much");
  list("label_rule", label_rule, "which cells become free");
  list("wall_contrast", wall_contrast, {0, 1},
       "a cell before an obstacle whose state is higher by more than this is unknown; 1 = never");
  list("min_reach", min_reach, {0, 1},
       "a surface occupies a cell when the mean of its points reaches into it by more than this "
       "share of its edge; 1 = states alone decide");
  list("face_bias_m", face_bias_m, {0.001, 1},
       "what does not average out of that mean; a cell before a border it is behind by less is "
       "unknown");
  list("hidden_cells", hidden_cells,
       "free space apart from the robot's, and obstacles that touch no free space");
}

void validate(const NavmapParams& params) {
  if (params.column == ColumnRule::band && params.min_height_m > params.max_height_m)
    throw UsageError(fmt::format("navmap: min_height_m {} is above max_height_m {}",
                                 params.min_height_m, params.max_height_m));
}

}  // namespace stereovox
