#include "stereovox/io/image_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr std::int64_t kMaxPixels = 64LL << 20;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

// The bytes of a file; reading beyond their end means that the file is cut off.
struct Bytes {
  std::string_view all;
  const std::string& name;

  [[noreturn]] void fail(const std::string& what) const { throw Error(name + ": " + what); }
  [[noreturn]] void fail_cut_off() const { fail(fmt::format("is cut off ({} bytes)", all.size())); }
  void need(std::uint64_t end) const {
    if (end > all.size()) fail_cut_off();
  }
  std::uint32_t byte(std::uint64_t at) const {
    need(at + 1);
    return static_cast<unsigned char>(all[at]);
  }
  std::uint32_t big_endian(std::uint64_t at, int count) const {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | byte(at + static_cast<unsigned>(i));
    return value;
  }
  std::uint32_t little_endian(std::uint64_t at, int count) const {
    std::uint32_t value = 0;
    for (int i = count - 1; i >= 0; --i) value = value << 8 | byte(at + static_cast<unsigned>(i));
    return value;
  }
};

int checked_side(const Bytes& file, std::int64_t side) {
  if (side < 1 || side > kMaxPixels) file.fail(fmt::format("has a side of {} pixels", side));
  return static_cast<int>(side);
}

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xEDB88320U : 0U);
  }
  return table;
}

// CRC-32 as in PNG (ISO 3309).
std::uint32_t crc32(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = make_crc_table();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 0xFF] ^ crc >> 8;
  return ~crc;
}

// PNG: chunks of length, type, data and checksum, from IHDR to IEND.
ImageHeader inspect_png(const Bytes& file) {
  constexpr std::uint64_t kFirstChunk = 8, kAroundData = 12, kIhdrEnd = 33;
  constexpr std::uint32_t kGrey = 0, kPalette = 3, kGreyAlpha = 4;
  file.need(kIhdrEnd);
  const std::uint32_t colour_type = file.byte(25);
  ImageHeader header{.format = "PNG",
                     .width = checked_side(file, file.big_endian(16, 4)),
                     .height = checked_side(file, file.big_endian(20, 4)),
                     .has_palette = colour_type == kPalette,
                     .is_grey = colour_type == kGrey || colour_type == kGreyAlpha};
  for (std::uint64_t at = kFirstChunk;;) {
    const std::uint64_t length = file.big_endian(at, 4);
    file.need(at + kAroundData + length);
    const std::string_view type = file.all.substr(at + 4, 4);
    if (crc32(file.all.substr(at + 4, 4 + length)) != file.big_endian(at + 8 + length, 4))
      file.fail(fmt::format("is damaged (checksum of the chunk at byte {})", at));
    if (type == "IEND") return header;
    at += kAroundData + length;
  }
}

// First position from `at` on that holds a marker other than a restart; all before is coded pixels.
std::uint64_t skip_coded_pixels(const Bytes& file, std::uint64_t at) {
  for (;; ++at) {
    at = file.all.find('\xFF', at);
    if (at == std::string_view::npos) file.fail_cut_off();
    const std::uint32_t next = file.byte(at + 1);
    const bool is_stuffing = next == 0x00 || next == 0xFF,
               is_restart = next >= 0xD0 && next <= 0xD7;
    if (!is_stuffing && !is_restart) return at;
  }
}

// JPEG: segments of marker and length up to the end marker. A frame marker holds the size.
ImageHeader inspect_jpeg(const Bytes& file) {
  constexpr std::uint32_t kEnd = 0xD9, kFirstFrame = 0xC0, kLastFrame = 0xCF;
  constexpr std::array<std::uint32_t, 3> kNoFrames = {0xC4, 0xC8, 0xCC};
  ImageHeader header{.format = "JPEG"};
  for (std::uint64_t at = 2;;) {
    at = skip_coded_pixels(file, at) + 2;
    const std::uint32_t marker = file.byte(at - 1);
    if (marker == kEnd) break;
    const std::uint32_t length = file.big_endian(at, 2);
    if (marker >= kFirstFrame && marker <= kLastFrame && !std::ranges::count(kNoFrames, marker)) {
      header.height = checked_side(file, file.big_endian(at + 3, 2));
      header.width = checked_side(file, file.big_endian(at + 5, 2));
    }
    at += std::max(length, 2U);
  }
  if (header.width == 0) file.fail("is damaged (no frame header)");
  return header;
}

// Not those of the C library, which depend on the locale.
bool is_blank(std::uint32_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_digit(std::uint32_t c) { return c >= '0' && c <= '9'; }

// The next number of a PNM header, after blanks and comments.
std::int64_t pnm_number(const Bytes& file, std::uint64_t& at) {
  while (is_blank(file.byte(at)) || file.byte(at) == '#')
    at = file.byte(at) == '#' ? std::min(file.all.find('\n', at), file.all.size()) : at + 1;
  std::int64_t value = 0;
  const std::uint64_t begin = at;
  for (; is_digit(file.byte(at)) && value <= kMaxPixels; ++at)
    value = 10 * value + file.byte(at) - '0';
  if (at == begin) file.fail(fmt::format("is damaged (no number at byte {})", at));
  return value;
}

// PGM, PPM, PBM: the plain forms P1 to P3 are text and end where the decoder finds that they end.
ImageHeader inspect_pnm(const Bytes& file) {
  constexpr std::int64_t kMaxValue = 65535, kMaxByte = 255;
  const char kind = file.all[1];
  const bool is_bitmap = kind == '1' || kind == '4', is_colour = kind == '3' || kind == '6';
  std::uint64_t at = 2;
  ImageHeader header{.format = "PNM"};
  header.width = checked_side(file, pnm_number(file, at));
  header.height = checked_side(file, pnm_number(file, at));
  const std::int64_t max_value = is_bitmap ? kMaxByte : pnm_number(file, at);
  if (max_value < 1 || max_value > kMaxValue)
    file.fail(fmt::format("has a largest value of {}, it must be 1 to {}", max_value, kMaxValue));
  header.max_value = static_cast<int>(max_value);
  const bool is_binary = kind >= '4';
  const std::int64_t row_bytes = is_bitmap
                                     ? (header.width + 7) / 8
                                     : static_cast<std::int64_t>(header.width) *
                                           (is_colour ? 3 : 1) * (max_value > kMaxByte ? 2 : 1);
  if (is_binary) file.need(at + 1 + static_cast<std::uint64_t>(row_bytes * header.height));
  return header;
}

ImageHeader inspect_bmp(const Bytes& file) {
  constexpr std::uint32_t kOldHeaderBytes = 12, kUncompressed = 0;
  const std::uint64_t pixels_at = file.little_endian(10, 4);
  const bool is_old = file.little_endian(14, 4) == kOldHeaderBytes;
  const auto side = [&](std::uint64_t old_at, std::uint64_t at) {
    return is_old ? static_cast<std::int64_t>(file.little_endian(old_at, 2))
                  : std::abs(std::int64_t{static_cast<std::int32_t>(file.little_endian(at, 4))});
  };
  const ImageHeader header{.format = "BMP",
                           .width = checked_side(file, side(18, 18)),
                           .height = checked_side(file, side(20, 22))};
  const std::uint64_t bits = file.little_endian(is_old ? 24 : 28, 2);
  const std::uint64_t row_bytes = (static_cast<std::uint64_t>(header.width) * bits + 31) / 32 * 4;
  if (is_old || file.little_endian(30, 4) == kUncompressed)
    file.need(pixels_at + row_bytes * static_cast<std::uint64_t>(header.height));
  return header;
}

// A TIFF file: a table of tags, each with one or more whole numbers.
struct Tiff {
  const Bytes& file;
  bool is_little_endian;

  std::uint32_t number(std::uint64_t at, int count) const {
    return is_little_endian ? file.little_endian(at, count) : file.big_endian(at, count);
  }
  std::uint32_t count(std::uint64_t entry) const { return number(entry + 4, 4); }
  std::uint32_t value(std::uint64_t entry, std::uint64_t index) const {
    constexpr std::uint32_t kShort = 3;
    const int bytes = number(entry + 2, 2) == kShort ? 2 : 4;
    const bool is_inline = count(entry) * std::uint64_t(bytes) <= 4;
    return number((is_inline ? entry + 8 : number(entry + 8, 4)) + index * std::uint64_t(bytes),
                  bytes);
  }
  // The first table, its tags and the link to the next must lie inside the file.
  void check_table() const {
    const std::uint64_t table = number(4, 4);
    file.need(table + 2 + 12 * std::uint64_t{number(table, 2)} + 4);
  }
  // Position of a tag in the first table, 0 when absent.
  std::uint64_t find(std::uint32_t tag) const {
    const std::uint64_t table = number(4, 4);
    const std::uint32_t entries = number(table, 2);
    for (std::uint64_t i = 0; i < entries; ++i)
      if (number(table + 2 + 12 * i, 2) == tag) return table + 2 + 12 * i;
    return 0;
  }
  // The pieces of the image (strips or tiles) must lie inside the file.
  void check_pieces(std::uint32_t offsets_tag, std::uint32_t sizes_tag) const {
    const std::uint64_t offsets = find(offsets_tag), sizes = find(sizes_tag);
    if (offsets == 0 || sizes == 0) return;
    for (std::uint64_t i = 0; i < std::min(count(offsets), count(sizes)); ++i)
      file.need(std::uint64_t{value(offsets, i)} + value(sizes, i));
  }
};

ImageHeader inspect_tiff(const Bytes& file) {
  constexpr std::uint32_t kWidth = 256, kHeight = 257;
  constexpr std::uint32_t kStrips = 273, kStripBytes = 279, kTiles = 324, kTileBytes = 325;
  const Tiff tiff{file, file.all.starts_with("II")};
  tiff.check_table();
  const std::uint64_t width = tiff.find(kWidth), height = tiff.find(kHeight);
  if (width == 0 || height == 0) file.fail("is damaged (its size is not given)");
  tiff.check_pieces(kStrips, kStripBytes);
  tiff.check_pieces(kTiles, kTileBytes);
  return {.format = "TIFF",
          .width = checked_side(file, tiff.value(width, 0)),
          .height = checked_side(file, tiff.value(height, 0))};
}

ImageHeader inspect_known(const Bytes& file) {
  using namespace std::string_view_literals;
  const std::string_view all = file.all;
  if (all.starts_with(kPngSignature)) return inspect_png(file);
  if (all.starts_with("\xFF\xD8\xFF")) return inspect_jpeg(file);
  if (all.size() > 2 && all[0] == 'P' && all[1] >= '1' && all[1] <= '6') return inspect_pnm(file);
  if (all.starts_with("BM")) return inspect_bmp(file);
  if (all.starts_with("II*\0"sv) || all.starts_with("MM\0*"sv)) return inspect_tiff(file);
  if (kPngSignature.starts_with(all)) file.fail_cut_off();
  file.fail("is not a PNG, PGM, JPEG, BMP or TIFF image");
}

}  // namespace

ImageHeader inspect_image(std::string_view bytes, const std::string& name) {
  const Bytes file{bytes, name};
  if (bytes.empty()) file.fail("is empty");
  const ImageHeader header = inspect_known(file);
  if (std::int64_t{header.width} * header.height > kMaxPixels)
    file.fail(fmt::format("size is {} x {}, at most 64 megapixels are read", header.width,
                          header.height));
  return header;
}

}  // namespace stereovox
