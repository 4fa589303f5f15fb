// Correlation of two maps (eq. 19; method.md, B.1): Pearson's coefficient over the union of their
// extents, unknown cells and cells beyond a map included as 0.5.
#pragma once

#include "stereovox/evaluation/value_grid.h"

namespace stereovox {

struct Correlation {
  double coefficient = 0;  // in [-1, 1]; 0 when flat
  bool is_flat = false;    // one of the maps has the same value everywhere
};

// `shift_cells` moves `b` against `a`. Throws Error as lattice_offset.
Correlation correlation(const ValueGrid& a, const ValueGrid& b,
                        const Eigen::Vector2i& shift_cells = {0, 0});

struct BestShift {
  double coefficient = 0;
  Eigen::Vector2i shift_cells = {0, 0};
};

// Over all shifts of `b` by up to `max_shift_cells` along each axis; of equal ones the shortest,
// then the first by y, then x.
BestShift best_shift(const ValueGrid& a, const ValueGrid& b, int max_shift_cells);

// As MapManager (O'Sullivan 2005), the tool behind the published figures, prints it.
double truncated_to_4_decimals(double coefficient);

}  // namespace stereovox
