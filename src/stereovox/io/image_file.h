// Images from and to files. Nothing is printed and nothing is guessed: a file that is not whole is
// an Error "<path>: is cut off (12345 bytes)", "is empty", "is damaged ...", "size is ...".
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "stereovox/core/image.h"

namespace stereovox {

struct LoadedImage {
  GrayImage image;
  std::string conversion;  // "16 bit, scaled to 8"; empty when the file is 8-bit grey
};

// PNG, PGM, JPEG, BMP or TIFF of up to 64 megapixels: grey or colour, 8 or 16 bit, palette and
// alpha.
LoadedImage read_gray_image(const std::filesystem::path& path);

// The pixels as stored: 8 or 16 bit, 1 (grey), 3 (BGR) or 4 (BGRA) channels.
cv::Mat read_image(const std::filesystem::path& path);

// Size of an image file that is whole, without decoding it.
cv::Size read_image_size(const std::filesystem::path& path);

// Whether the name ends as an image's does (.png .pgm .jpg .jpeg .bmp .tif .tiff in any case).
bool has_image_name(const std::filesystem::path& path);

// Atomically, 8 or 16 bit, 1, 3 or 4 channels.
void write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace stereovox
