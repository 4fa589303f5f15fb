// Map score (eq. 20; method.md, B.2 and B.3): how far the values of two maps are from each other,
// and Martin and Moravec's match, whose name the score had in the tool of the published figures.
#pragma once

#include <optional>

#include "stereovox/evaluation/value_grid.h"

namespace stereovox {

struct MapError {
  double sum = 0;  // of squared differences, as the tool gives it; below 1e-5 it is 0
  int cells = 0;   // summed over
  // 100 sum / cells, as published tables give it; nothing when there are no cells.
  std::optional<double> percent() const;
};

// Over all cells but those where both are unknown (exactly 0.5). All maps here are of one geometry.
MapError error_over_all(const ValueGrid& normalised, const ValueGrid& generated);
// Over the cells where either is above 0.5.
MapError error_over_occupied(const ValueGrid& normalised, const ValueGrid& generated);

// Sum over cells of 1 + log2(m n + (1 - m)(1 - n)), values clipped to [0.01, 0.99]; higher is
// better. `cells` counts those where neither is 0.5; the others add nothing.
struct MatchBits {
  double sum = 0;
  int cells = 0;
};
MatchBits match_bits(const ValueGrid& normalised, const ValueGrid& generated);

}  // namespace stereovox
