// SSIM of two maps as images (Wang, Bovik, Sheikh and Simoncelli 2004), with a uniform window.
#pragma once

#include <optional>

#include "stereovox/evaluation/value_grid.h"

namespace stereovox {

// Mean over all windows of 7 x 7 cells inside the maps; variances divided by 49, C1 = 0.01^2 and
// C2 = 0.03^2 for values in [0, 1]. Nothing when the maps, of one geometry, are smaller.
std::optional<double> structural_similarity(const ValueGrid& a, const ValueGrid& b);

}  // namespace stereovox
