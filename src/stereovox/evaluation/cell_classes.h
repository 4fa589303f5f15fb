// A map as a classifier of cells (method.md, B.7), judged where the ideal map is known. A figure
// without anything to average over is absent.
#pragma once

#include <cstdint>
#include <optional>

#include "stereovox/navmap/occupancy_grid_2d.h"

namespace stereovox {

struct CellClasses {
  // Occupied against not occupied (free or unknown), over the cells where the ideal is known.
  std::int64_t true_positive = 0, false_positive = 0, false_negative = 0, true_negative = 0;
  std::optional<double> precision, recall, f1, iou_occupied;
  // The same, with partners up to one cell away (eight neighbours).
  std::optional<double> tolerant_precision, tolerant_recall, tolerant_f1;
  std::optional<double> kappa, mcc;
  std::optional<double> iou_free;  // of the cells free in either map
  // Mean F1 of occupied, free and unknown over all cells, of the classes that occur.
  std::optional<double> macro_f1;
  // P(generated free | ideal occupied): where a robot would be told to drive into an obstacle.
  std::optional<double> false_free_rate;
  std::optional<double> coverage;     // known share of the cells where the ideal is known
  double known_fraction = 0;          // known share of all cells
  std::int64_t occupied_outside = 0;  // occupied cells where the ideal is unknown
};

// Both maps are of one geometry; `ideal` is normalised.
CellClasses score_classes(const OccupancyGrid2D& ideal, const OccupancyGrid2D& generated);

}  // namespace stereovox
