// Portable float maps with one channel: "Pf", width, height, a scale whose sign tells the byte
// order (negative = little endian), then 32-bit floats from the bottom row up.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace stereovox {

// The values as stored, top row first; infinite and NaN values are left to the caller. Throws Error
// "<path>: ..." for what is no such file, cut off, or larger than 64 megapixels.
cv::Mat1f read_pfm(const std::filesystem::path& path);

void write_pfm(const std::filesystem::path& path, const cv::Mat1f& image);

}  // namespace stereovox
