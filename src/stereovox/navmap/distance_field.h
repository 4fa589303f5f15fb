// How far each cell is from the nearest cell of a set, and which one that is: the exact Euclidean
// distance transform in two passes (Meijster, Roerdink and Hesselink, "A general algorithm for
// computing distance transforms in linear time", 2000). Time grows with the number of cells only.
//
//   const DistanceField2D clearance = distance_field(cells_labelled(map, CellLabel::occupied));
#pragma once

#include <vector>

#include "stereovox/navmap/cell_mask.h"

namespace stereovox {

struct DistanceField2D {
  GridGeometry geometry;
  std::vector<double> distance_m;  // between cell centres; infinite when the set is empty
  std::vector<int> nearest;        // position of that cell of the set; kNoCell when it is empty

  double at(int position) const { return distance_m[static_cast<std::size_t>(position)]; }
};

// Of several nearest cells the one with the smallest x, then the smallest y, is named.
DistanceField2D distance_field(const CellMask& sites);

}  // namespace stereovox
