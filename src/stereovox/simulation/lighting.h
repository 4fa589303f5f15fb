// Light that leaves a point of a surface towards the eye.
#pragma once

#include <span>
#include <vector>

#include "stereovox/simulation/scene.h"

namespace stereovox {

// A place that a pixel looks at.
struct Seen {
  Ray ray;
  Hit hit;
  float pixel_rad = 0.0F;  // angle of a pixel

  Eigen::Vector3f point_m() const { return ray.origin_m + hit.distance * ray.direction; }
};

// Brightness of each place; 0 where nothing was hit. Asks the scene for shadows and mirror images
// in large lists, which is what it is fast at.
std::vector<float> radiance_of(const World& world, const Scene& scene, std::span<const Seen> seen);

}  // namespace stereovox
