// What a camera sees of a scene: brightness before any imperfection of the camera, and depth.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stereovox/core/camera.h"
#include "stereovox/simulation/scene.h"

namespace stereovox {

// The direction in which each pixel of a calibrated camera looks, in its frame, with z = 1; one
// pixel more on every side, so that places between pixels are found by interpolation.
class PixelRays {
 public:
  explicit PixelRays(const CameraCalibration& camera);
  int width() const { return directions_.cols - 2; }
  int height() const { return directions_.rows - 2; }
  // u in [-1, width], v in [-1, height].
  Eigen::Vector3f direction(float u_px, float v_px) const;

 private:
  cv::Mat2f directions_;  // x / z and y / z
};

// Every pixel takes the light of lamps that nothing blocks, light from all sides, and on shiny
// surfaces a mirror image; pixels at edges average several rays. Brightness 1 is that of a white
// surface in the light of one lamp 1 m away.
cv::Mat1f render(const World& world, const Scene& scene, const PixelRays& rays,
                 const SE3& T_world_camera, int threads);

// Along the optical axis through the centres of the pixels; 0 = nothing there.
cv::Mat1f depth_of(const Scene& scene, const PixelRays& rays, const SE3& T_world_camera,
                   int threads);

// 255 where the right camera of a rectified pair does not see the point that the left one sees at
// that pixel: hidden by something nearer, or outside of the right image.
cv::Mat1b occluded_pixels(const Scene& scene, const PixelRays& left, const cv::Mat1f& left_depth_m,
                          const SE3& T_world_left, const RectifiedCamera& pair, int threads);

}  // namespace stereovox
