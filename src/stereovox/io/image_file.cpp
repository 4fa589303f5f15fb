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
constexpr double kMaxOf8Bit = 255.0;
constexpr int kBitsOf8 = 8, kBitsOf16 = 16;

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

bool states_no_depth(const Decoded& decoded) {
  return decoded.pixels.depth() == CV_16U && decoded.header.max_value == 0;
}

// The fewest bits of those that cameras have which hold the largest value of a 16-bit file.
int used_bits_of(const Decoded& decoded) {
  if (!states_no_depth(decoded)) return kBitsOf8;
  double largest = 0;
  cv::minMaxIdx(decoded.pixels.reshape(1), nullptr, &largest);
  int bits = kBitsOf8;
  while (largest >= (1 << bits)) bits += 2;
  return bits;
}

// 8 bit, with the file's largest possible value at 255.
cv::Mat scaled_to_8_bit(const Decoded& decoded, int used_bits) {
  const double type_max = states_no_depth(decoded) ? (1 << used_bits) - 1 : kMaxOf8Bit;
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

std::string conversion_of(const Decoded& decoded, int used_bits) {
  const int channels = decoded.pixels.channels(), max_value = decoded.header.max_value;
  std::vector<std::string> parts;
  if (decoded.pixels.depth() == CV_16U)
    parts.push_back(states_no_depth(decoded) && used_bits < kBitsOf16
                        ? fmt::format("16 bit of which {} are used, scaled to 8", used_bits)
                        : "16 bit, scaled to 8");
  if (decoded.pixels.depth() == CV_8U && max_value > 0 && max_value < kMaxOf8Bit)
    parts.push_back("less than 8 bit, scaled to 8");
  if (channels > 1 && !decoded.header.is_grey)
    parts.push_back(decoded.header.has_palette ? "palette, turned to grey"
                                               : "colour, turned to grey");
  if (channels == 4) parts.push_back("alpha left out");
  return fmt::format("{}", fmt::join(parts, "; "));
}

LoadedImage converted(const Decoded& decoded, int used_bits) {
  return {{to_gray(scaled_to_8_bit(decoded, used_bits))}, conversion_of(decoded, used_bits)};
}

}  // namespace

LoadedImage read_gray_image(const std::filesystem::path& path) {
  const Decoded decoded = decode(path);
  return converted(decoded, used_bits_of(decoded));
}

LoadedPair read_gray_pair(const std::filesystem::path& left, const std::filesystem::path& right,
                          int& used_bits) {
  const Decoded decoded_left = decode(left), decoded_right = decode(right);
  used_bits = std::max({used_bits, used_bits_of(decoded_left), used_bits_of(decoded_right)});
  return {converted(decoded_left, used_bits), converted(decoded_right, used_bits)};
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
