#include "stereovox/io/pfm.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::int64_t kMaxPfmPixels = 64LL << 20;
constexpr std::uint64_t kMaxHeaderBytes = 4096;
constexpr std::string_view kBlanks = " \t\r\n";

// Takes the next word off the front of `text`, with the single blank that ends it.
std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(std::min(word.size() + 1, text.size()));
  return word;
}

float float_at(const char* bytes, bool is_little_endian) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  if (is_little_endian != (std::endian::native == std::endian::little))
    bits = __builtin_bswap32(bits);
  return std::bit_cast<float>(bits);
}

}  // namespace

cv::Mat1f read_pfm(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, kMaxPfmPixels * sizeof(float) + kMaxHeaderBytes);
  const auto fail = [&](const std::string& what) { return Error(path.string() + ": " + what); };
  std::string_view rest = bytes;
  if (take_word(rest) != "Pf") throw fail("is not a one-channel PFM file");
  const std::string_view width_text = take_word(rest), height_text = take_word(rest);
  const std::int64_t width = parse_integer(width_text).value_or(0);
  const std::int64_t height = parse_integer(height_text).value_or(0);
  const double scale = parse_number(take_word(rest)).value_or(0.0);
  if (width < 1 || height < 1 || width > kMaxPfmPixels || height > kMaxPfmPixels / width)
    throw fail(fmt::format("size is {} x {}, at most 64 megapixels are read", in_quotes(width_text),
                           in_quotes(height_text)));
  if (!std::isfinite(scale) || scale == 0.0) throw fail("its scale is no number or zero");
  if (rest.size() < sizeof(float) * static_cast<std::uint64_t>(width * height))
    throw fail(fmt::format("is cut off ({} bytes); it should hold {} x {} pixels", bytes.size(),
                           width, height));

  cv::Mat1f image(static_cast<int>(height), static_cast<int>(width));
  const char* pixel = rest.data();
  for (int y = image.rows - 1; y >= 0; --y)  // the bottom row comes first
    for (int x = 0; x < image.cols; ++x, pixel += sizeof(float))
      image(y, x) = float_at(pixel, scale < 0.0);
  return image;
}

void write_pfm(const std::filesystem::path& path, const cv::Mat1f& image) {
  constexpr const char* kScale = std::endian::native == std::endian::little ? "-1.0" : "1.0";
  write_file_atomically(path, [&](std::ostream& out) {
    out << fmt::format("Pf\n{} {}\n{}\n", image.cols, image.rows, kScale);
    for (int y = image.rows - 1; y >= 0; --y)
      out.write(reinterpret_cast<const char*>(image[y]),
                static_cast<std::streamsize>(sizeof(float)) * image.cols);
  });
}

}  // namespace stereovox
