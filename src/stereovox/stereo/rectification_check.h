// Are these images rectified, and is left left? Measured on the images themselves, because a wrong
// calibration otherwise shows only as a bad map.
#pragma once

#include <string>
#include <vector>

#include "stereovox/core/frame.h"
#include "stereovox/stereo/rectifier.h"

namespace stereovox {

// Corners of a left image found again in the right one, within rows of `v` +- kSearchRows_px.
struct CornerOffsets {
  std::vector<double> vertical_px;   // v_right - v_left, sub-pixel
  std::vector<double> disparity_px;  // u_left - u_right, of either sign
};

CornerOffsets measure_corner_offsets(const RectifiedPair& pair);

struct RectificationCheck {
  int corners = 0;
  double vertical_px = 0.0;     // median of the sizes: a rolled camera has as many of either sign
  double negative_share = 0.0;  // of the corners whose disparity is clearly not zero

  // Fewer matched corners prove nothing.
  bool is_conclusive() const { return corners >= 20; }
  bool looks_swapped() const { return is_conclusive() && negative_share > 0.8; }
};

// Pools the corners of several pairs.
RectificationCheck summarize(const std::vector<CornerOffsets>& offsets);

// Throws Error "<source>: ..." when the images must not be used: left and right swapped, or a
// median vertical offset at or above params.refuse_offset_px. Returns a warning above
// params.warn_offset_px, else "".
std::string judge(const RectificationCheck& check, const RectificationParams& params,
                  const std::string& source);

}  // namespace stereovox
