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
// alpha. 16 bits are scaled by the largest value that a PGM states; other files do not say how many
// of their bits a camera filled, so those count as used that the largest value needs: 8, 10, 12, 14
// or 16. Colour becomes 0.299 R + 0.587 G + 0.114 B.
LoadedImage read_gray_image(const std::filesystem::path& path);

// Both images scaled alike: by the bits that either of them uses, and by no fewer than `used_bits`,
// which afterwards says by how many. Handed from pair to pair it keeps dark ones dark.
struct LoadedPair {
  LoadedImage left, right;
};
LoadedPair read_gray_pair(const std::filesystem::path& left, const std::filesystem::path& right,
                          int& used_bits);

// The pixels as stored: 8 or 16 bit, 1 (grey), 3 (BGR) or 4 (BGRA) channels.
cv::Mat read_image(const std::filesystem::path& path);

// Size of an image file that is whole, without decoding it.
cv::Size read_image_size(const std::filesystem::path& path);

// Whether the name ends as an image's does (.png .pgm .jpg .jpeg .bmp .tif .tiff in any case).
bool has_image_name(const std::filesystem::path& path);

// Atomically, 8 or 16 bit, 1, 3 or 4 channels.
void write_png(const std::filesystem::path& path, const cv::Mat& image);

}  // namespace stereovox
