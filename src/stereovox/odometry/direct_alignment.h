// Where a camera is, from the brightness of all pixels of known distance together (Steinbruecker,
// Sturm, Cremers 2011; Kerl, Sturm, Cremers 2013). It needs no corner, so it works before walls
// that are all but blank, but only from a start near by.
#pragma once

#include <span>

#include "stereovox/core/camera.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"

namespace stereovox {

struct DirectParams {
  double min_overlap = 0.4;
  double min_correlation = 0.98;  // motions wrong by 2 to 13 degrees reached 0.9 to 0.95

  void describe(ParameterList& list) {
    list("min_overlap", min_overlap, {0.0, 1.0},
         "share of a keyframe's pixels of known distance that the current image must show");
    list("min_correlation", min_correlation, {0.0, 1.0},
         "least normalised correlation of their brightness");
  }
};

// What a reference view knows of its surfaces at one size of its image.
struct SurfaceLevel {
  GrayImage left;
  cv::Mat1f disparity_px;  // 0 = none
};

// Reference and current image at one size, and the camera that takes images of this size.
struct DirectPair {
  const RectifiedCamera& camera;
  const SurfaceLevel& reference;
  const GrayImage& current;
};

struct DirectAlignment {
  SE3 T_reference_camera = {};
  Matrix6d covariance = Matrix6d::Zero();  // of the twist x in T_true = T_reference_camera * exp(x)
  double overlap = 0.0;                    // share of the pixels with a disparity that are in view
  double correlation = 0.0;                // normalised, of their brightness in both images
};

// From the coarsest pair to the finest, the last of which gives covariance, overlap and
// correlation. Brightness and contrast may differ between the images. The covariance is infinite
// when the brightness does not fix the motion.
DirectAlignment align_directly(std::span<const DirectPair> coarse_to_fine, const SE3& start);

}  // namespace stereovox
