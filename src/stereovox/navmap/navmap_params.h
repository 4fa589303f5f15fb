// How the 3D map becomes a 2D one: the choices of method.md, eqs. 17 and 18 and the section
// "Threshold and labels".
#pragma once

#include "stereovox/core/parameters.h"

namespace stereovox {

// What sets column, min_observations, free_threshold, label_rule, wall_contrast, min_reach and
// hidden_cells together; what is set after it stays.
enum class NavmapPreset {
  literal,    // as the paper prints it
  corrected,  // its errors mended
  tuned,      // the same formulas, but doubtful cells stay unknown
};
std::span<const std::string> names_of(NavmapPreset);

// Which voxels of a column speak for the cell below them.
enum class ColumnRule {
  whole,  // all: floor and ceiling occupy every cell
  band,   // those at the heights of the robot
};
std::span<const std::string> names_of(ColumnRule);

// Which cells become free.
enum class LabelRule {
  as_printed,  // all cells between the robot and every occupied cell, also behind other ones
  visible,  // cells seen free in 3D, and those before the first occupied cell on the way from the
            // robot to an occupied cell that this frame hit
};
std::span<const std::string> names_of(LabelRule);

// What becomes of cells that no sight line can have reached (hidden_cells.h).
enum class HiddenCells { keep, unknown };
std::span<const std::string> names_of(HiddenCells);

struct NavmapParams {
  NavmapPreset preset = NavmapPreset::corrected;
  ColumnRule column = ColumnRule::band;
  double min_height_m = 0.15, max_height_m = 1.5;  // of a voxel's centre, above the map's floor
  int min_observations = 3;                        // voxels observed less often do not count
  double threshold = 0.5;
  double free_threshold = 0.5;
  double hysteresis = 0.0;
  LabelRule label_rule = LabelRule::visible;
  double wall_contrast = 1.0;
  double min_reach = 1.0;
  double face_bias_m = 0.01;
  HiddenCells hidden_cells = HiddenCells::keep;

  // Whether the layers of cells before obstacles are looked at (thin_walls.h).
  bool thins_walls() const { return wall_contrast < 1.0 || uses_faces(); }
  bool uses_faces() const { return min_reach < 1.0; }

  void describe(ParameterList& list);
};

// Throws UsageError when the band is upside down.
void validate(const NavmapParams& params);

}  // namespace stereovox
