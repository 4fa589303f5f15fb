// The mean of what the pixels around a pixel say of its surface, before the frame enters the map. A
// voxel far away is seen by many pixels, each with an error of several voxels; marked one by one
// they make a wall a cloud. A plane's disparity is linear in the image, so the mean of two pixels
// on opposite sides is the plane's in the middle, however slanted it is.
//
// Pixel p with disparity d and standard deviation s becomes the mean of itself and of all pairs p +
// o, p - o in the window around it whose disparities both lie within gate_sigmas s of d. Across the
// edge of an object nothing is averaged. Standard deviations stay: a matcher's errors at
// neighbouring pixels are alike, so that the mean of them need not be surer.
#pragma once

#include <span>

#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"
#include "stereovox/occupancy/vector_target.h"

namespace stereovox {

struct SmoothingParams {
  int radius_px = 0;
  double gate_sigmas = 4.0;

  void describe(ParameterList& list) {
    list("radius_px", radius_px, {0, 16},
         "a disparity becomes the mean of those of its surface this near; 0 = stays as it is");
    list("gate_sigmas", gate_sigmas, {0, 100},
         "pixels that differ by more standard deviations belong to another surface");
  }
};

// Of these rows; the others stay as they are. Throws std::logic_error when disparities and standard
// deviations differ in size.
DisparityImage smoothed(const DisparityImage& image, const SmoothingParams& params,
                        std::span<const int> rows, int threads,
                        VectorTarget target = best_target());

}  // namespace stereovox
