// A rectified pair with exact disparity: the right image is smooth random texture, the left one is
// drawn from it pixel by pixel.
#pragma once

#include <functional>
#include <opencv2/imgproc.hpp>

#include "stereovox/core/frame.h"

namespace stereovox {

inline cv::Mat1b random_texture(cv::Size size, unsigned seed) {
  cv::RNG random(seed);
  cv::Mat1b noise(size);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(noise, noise, {5, 5}, 1.0);
  cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX);
  return noise;
}

// disparity_px(u, v) of the left image; rows of the left image sample rows v + vertical_px.
inline RectifiedPair synthetic_pair(cv::Size size,
                                    const std::function<double(int, int)>& disparity_px,
                                    double vertical_px = 0.0, unsigned seed = 1) {
  RectifiedPair pair;
  pair.right.pixels = random_texture(size, seed);
  cv::Mat1f map_u(size), map_v(size);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      map_u(v, u) = static_cast<float>(u - disparity_px(u, v));
      map_v(v, u) = static_cast<float>(v + vertical_px);
    }
  cv::remap(pair.right.pixels, pair.left.pixels, map_u, map_v, cv::INTER_CUBIC, cv::BORDER_REFLECT);
  return pair;
}

}  // namespace stereovox
