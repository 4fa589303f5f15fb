// Where a camera is, from the brightness of all pixels of known distance together (Steinbruecker,
// Sturm, Cremers 2011; Kerl, Sturm, Cremers 2013), in both of its images. It needs no corner, so it
// works before walls that are all but blank, but only from a start near by.
#pragma once

#include <limits>
#include <span>

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/core/parameters.h"
#include "stereovox/core/se3.h"

namespace stereovox {

struct DirectParams {
  double min_overlap = 0.4;
  double min_correlation = 0.7;
  double max_residual_ratio = 2.0;

  void describe(ParameterList& list) {
    list("min_overlap", min_overlap, {0.0, 1.0},
         "share of a keyframe's pixels of known distance that the current image must show");
    list("min_correlation", min_correlation, {0.0, 1.0},
         "least normalised correlation of their detail");
    list("max_residual_ratio", max_residual_ratio, {1.0, 100.0},
         "their detail may differ by so many times what the keyframe's own two images differ by");
  }
};

// What is left of brightness without its mean over the surroundings: vignetting and lamps are gone,
// which do not stay with the surfaces. 128 + twice the difference, so that half a grey level counts
// and a strong edge does not count more than 64.
struct DetailPair {
  cv::Mat1b left, right;
};

DetailPair detail_of(const RectifiedPair& pair);

// What a reference view knows of its surfaces at one size of its image.
struct SurfaceLevel {
  DetailPair detail;
  cv::Mat1f disparity_px;  // 0 = none
};

// Reference and current images at one size, and the camera that takes images of this size.
struct DirectPair {
  const RectifiedCamera& camera;
  const SurfaceLevel& reference;
  const DetailPair& current;
};

struct DirectAlignment {
  SE3 T_reference_camera = {};
  Matrix6d covariance = Matrix6d::Zero();  // of the twist x in T_true = T_reference_camera * exp(x)
  // Of the left or the right image, whichever is worse:
  double overlap = 0.0;      // share of the pixels with a disparity that are in view
  double correlation = 0.0;  // normalised, of their detail in both views
  double residual_ratio = std::numeric_limits<double>::infinity();  // see DirectParams
};

// The reference is compared with both current images, so that its surfaces must fit in distance
// too. The coarsest images decide from which start to go on. Exposure and contrast may differ
// between the images. The covariance is infinite when the detail does not fix the motion.
DirectAlignment align_directly(std::span<const DirectPair> coarse_to_fine,
                               std::span<const SE3> starts_T_reference_camera);

}  // namespace stereovox
