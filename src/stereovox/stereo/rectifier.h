// Warps the recorded images so that corresponding points lie in the same row.
//
//   const Rectifier rectifier(sequence.rig(), config.rectification);
//   const RectifiedPair pair = rectifier.rectify(frame);
#pragma once

#include "stereovox/core/camera.h"
#include "stereovox/core/frame.h"
#include "stereovox/core/parameters.h"

namespace stereovox {

struct RectificationParams {
  double alpha = 0.0;
  double warn_offset_px = 0.5;
  double refuse_offset_px = 1.5;

  void describe(ParameterList& list) {
    list("alpha", alpha, {0, 1},
         "0 keeps only pixels that both cameras saw, 1 keeps all pixels, in between a mixture");
    list("warn_offset_px", warn_offset_px, {0, 100},
         "median vertical offset of matched corners that brings a warning");
    list("refuse_offset_px", refuse_offset_px, {0, 100},
         "median vertical offset of matched corners at which the images are refused");
  }
};

// Owns the warping tables. A rig that is rectified already passes its images through unchanged.
class Rectifier {
 public:
  Rectifier(const StereoRig& rig, const RectificationParams& params);

  const RectifiedCamera& camera() const { return camera_; }

  // The rectified left camera sits in the centre of the left camera, turned by this rotation.
  const SE3& T_left_rectified() const { return T_left_rectified_; }

  // The images must have the size of the rig's cameras. The result shares memory with the frame
  // when nothing is warped.
  RectifiedPair rectify(const StereoFrame& frame) const;

 private:
  // Fixed-point tables of cv::remap, and where they point into the recorded image.
  struct Warp {
    cv::Mat map, interpolation;
    cv::Mat1b valid;
  };
  static Warp make_warp(const CameraCalibration& camera, const cv::Mat& R, const cv::Mat& P);

  RectifiedCamera camera_;
  SE3 T_left_rectified_;
  Warp left_, right_;  // empty when the rig is rectified already
};

}  // namespace stereovox
