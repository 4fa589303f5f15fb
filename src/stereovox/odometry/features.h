// Corners of the left image with their place in space and the look of their surroundings
// (Hirschmueller, Innocent, Garibaldi 2002; vision.md 1.7, steps 1 and 2).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

struct FeatureParams {
  int max_count = 400;
  double min_gradient_px = 1.5;

  void describe(ParameterList& list) {
    list("max_count", max_count, {20, 5000}, "corners used of one image, spread over it");
    list("min_gradient_px", min_gradient_px, {0.0, 100.0},
         "least rms brightness change per pixel of a corner, in its weakest direction");
  }
};

// The 11 x 11 pixels around a corner, with zero mean and unit length up to the factor
// kDescriptorScale, padded with zeros.
inline constexpr int kDescriptorRadius_px = 5;
inline constexpr double kDescriptorScale = 8192.0;
using PatchDescriptor = std::array<std::int16_t, 128>;

struct Feature {
  Eigen::Vector2d pixel;  // in the left image
  double disparity_px;    // > 0
  double sigma_px;        // of the disparity
};

// Entry i of both belongs to the same corner.
struct FeatureSet {
  std::vector<Feature> features;
  std::vector<PatchDescriptor> descriptors;
};

// The strongest corners (Shi, Tomasi 1994) of a grid of cells, at most one each, that have a
// disparity and lie in the valid part of the image. Exact integer arithmetic decides which.
FeatureSet extract_features(const RectifiedPair& pair, const DisparityImage& disparity,
                            const FeatureParams& params);

// Place of a feature in the frame of the camera that saw it.
Eigen::Vector3d position_of(const RectifiedCamera& camera, const Feature& feature);

// Zero-mean normalised correlation, -1 to 1.
double correlation(const PatchDescriptor& a, const PatchDescriptor& b);

}  // namespace stereovox
