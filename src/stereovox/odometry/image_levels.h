// Smaller forms of a pair, each with half the size of the one before. The mean of four pixels has
// half their noise, so weak and large patterns, which the full image hides, show corners there.
#pragma once

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"

namespace stereovox {

struct PairLevel {
  RectifiedPair pair;
  DisparityImage disparity;
};

// Each pixel is the mean of 2 x 2; the last column and row of an odd size are left out. It is valid
// where all four are, and has a disparity where most of the four have one, in pixels of the smaller
// image. Sizes below 2 give empty images.
PairLevel halved(const PairLevel& level);

// The camera that takes the smaller images.
RectifiedCamera halved(const RectifiedCamera& camera);

}  // namespace stereovox
