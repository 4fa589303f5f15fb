// A map laid over the ideal one, as a picture that shows where it errs.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/evaluation/ideal_map.h"

namespace stereovox {

// BGR; the region is the union of both extents. What a cell shows:
//   hit              occupied in both
//   missed           ideal occupied, unknown in the map
//   wrongly free     ideal occupied, free in the map: the dangerous error
//   invented         occupied in the map, and not in the ideal map (free or unknown there)
//   free             free in both
//   unseen           ideal free, unknown in the map
//   beyond           the ideal map does not know it, and the map does not call it occupied
// "Occupied" in the ideal map is that of the plan, so that the inside of a solid is no invention;
// what of it cannot be seen is not missed but beyond. Throws Error as union_of.
cv::Mat3b draw_score(const IdealMap& ideal, const OccupancyGrid2D& generated);

}  // namespace stereovox
