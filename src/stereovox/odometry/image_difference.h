// Which of two places of the camera its images speak for, by all pixels of known distance. Corners
// of a pattern that repeats fit as well a period away; what is fainter or larger than the pattern
// does not.
#pragma once

#include <span>

#include "stereovox/core/camera.h"
#include "stereovox/core/se3.h"
#include "stereovox/odometry/image_levels.h"

namespace stereovox {

// Two views at one size of their images, and the camera that takes images of this size.
struct ViewPair {
  const RectifiedCamera& camera;
  const PairLevel& reference;
  const PairLevel& current;
};

// The standard deviation by which the views differ with the current camera at `a`, over that at
// `b`: below 1 where `a` fits better. Geometric mean over both eyes and all sizes, of the pixels
// that the current images show from both places. What changes smoothly over the image, as exposure
// and vignetting do, is no difference. 1 when there are too few pixels to tell.
double difference_ratio(std::span<const ViewPair> views, const SE3& T_reference_a,
                        const SE3& T_reference_b);

}  // namespace stereovox
