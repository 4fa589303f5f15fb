#include "stereovox/io/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/image_header.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxImageBytes = 1ULL << 30;
constexpr double kMaxOf8Bit = 255.0, kMaxOf16Bit = 65535.0;

struct Decoded {
  cv::Mat pixels;
  ImageHeader header;
};

Decoded decode(const std::filesystem::path& path) {
  std::string bytes = read_file(path, kMaxImageBytes);
  Decoded decoded{{}, inspect_image(bytes, path.string())};
  try {
    const cv::Mat input(1, static_cast<int>(bytes.size()), CV_8U, bytes.data());
    decoded.pixels = cv::imdecode(input, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    decoded.pixels.release();
  }
  if (decoded.pixels.empty())
    throw Error(fmt::format("{}: is damaged, the {} decoder gives up", path.string(),
                            decoded.header.format));
  if (decoded.pixels.depth() != CV_8U && decoded.pixels.depth() != CV_16U)
    throw Error(path.string() + ": its pixels are neither 8 nor 16 bit whole numbers");
  return decoded;
}

// 8 bit, with the file's largest value at 255.
cv::Mat scaled_to_8_bit(const Decoded& decoded) {
  const double type_max = decoded.pixels.depth() == CV_16U ? kMaxOf16Bit : kMaxOf8Bit;
  const double max_value = decoded.header.max_value > 0 ? decoded.header.max_value : type_max;
  if (max_value == kMaxOf8Bit && decoded.pixels.depth() == CV_8U) return decoded.pixels;
  cv::Mat scaled;
  decoded.pixels.convertTo(scaled, CV_8U, kMaxOf8Bit / max_value);
  return scaled;
}

cv::Mat1b to_gray(const cv::Mat& pixels) {
  if (pixels.channels() == 1) return pixels;
  cv::Mat1b gray;
  cv::cvtColor(pixels, gray, pixels.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  return gray;
}

std::string conversion_of(const Decoded& decoded) {
  const int channels = decoded.pixels.channels(), max_value = decoded.header.max_value;
  std::vector<std::string_view> parts;
  if (decoded.pixels.depth() == CV_16U) parts.push_back("16 bit, scaled to 8");
  if (decoded.pixels.depth() == CV_8U && max_value > 0 && max_value < kMaxOf8Bit)
    parts.push_back("less than 8 bit, scaled to 8");
  if (channels > 1 && !decoded.header.is_grey)
    parts.push_back(decoded.header.has_palette ? "palette, turned to grey"
                                               : "colour, turned to grey");
  if (channels == 4) parts.push_back("alpha left out");
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

LoadedImage read_gray_image(const std::filesystem::path& path) {
  const Decoded decoded = decode(path);
  return {{to_gray(scaled_to_8_bit(decoded))}, conversion_of(decoded)};
}

cv::Mat read_image(const std::filesystem::path& path) { return decode(path).pixels; }

cv::Size read_image_size(const std::filesystem::path& path) {
  const ImageHeader header = inspect_image(read_file(path, kMaxImageBytes), path.string());
  return {header.width, header.height};
}

bool has_image_name(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 7> kExtensions = {".png", ".pgm", ".jpg", ".jpeg",
                                                           ".bmp", ".tif", ".tiff"};
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return std::ranges::count(kExtensions, extension) > 0;
}

void write_png(const std::filesystem::path& path, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  write_file_atomically(path, [&](std::ostream& out) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  });
}

}  // namespace stereovox
