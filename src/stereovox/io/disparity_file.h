// Disparity images in files, by extension: .pfm (32-bit floats) or .png (KITTI: 16 bit,
// disparity_px * 256). 0 = none in both.
#pragma once

#include <filesystem>

#include "stereovox/core/image.h"

namespace stereovox {

// sigma_px is 0 everywhere: the files hold none. In a PFM, infinite (Middlebury), NaN and negative
// values are read as none.
DisparityImage read_disparity(const std::filesystem::path& path);

// Does not write sigma_px. A PNG holds disparities below 256 px to 1/256 px (larger ones throw
// Error); those that would round to 0 become 1/256 px, because 0 means none.
void write_disparity(const std::filesystem::path& path, const DisparityImage& disparity);

}  // namespace stereovox
