#include "stereovox/io/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/image_header.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kFormats[] = {".png", ".jpg", ".pgm", ".bmp", ".tiff"};

// All grey values, not the same in any two rows.
cv::Mat1b test_image() {
  cv::Mat1b image(16, 24);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) image(v, u) = static_cast<unsigned char>(11 * u + 17 * v);
  return image;
}

std::string encoded(const char* extension, const cv::Mat& image,
                    const std::vector<int>& options = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(extension, image, bytes, options);
  return {bytes.begin(), bytes.end()};
}

std::string big_endian(std::uint32_t value) {
  return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

// CRC-32 one bit at a time, unlike the reader's.
std::string png_chunk(const std::string& type_and_data) {
  std::uint32_t crc = ~0U;
  for (const char c : type_and_data)
    for (int bit = 0; bit < 8; ++bit) {
      const bool is_odd = (crc ^ (static_cast<unsigned char>(c) >> bit)) & 1U;
      crc = (crc >> 1) ^ (is_odd ? 0xEDB88320U : 0U);
    }
  return big_endian(static_cast<std::uint32_t>(type_and_data.size() - 4)) + type_and_data +
         big_endian(~crc);
}

// A PNG of one row whose pixel bytes are stored uncompressed.
std::string png_of_one_row(std::uint32_t width, char depth, char colour_type,
                           const std::string& row, const std::string& more_chunks = "") {
  const std::string filtered = "\0"s + row;
  const auto size = static_cast<std::uint16_t>(filtered.size());
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const char c : filtered) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const std::string deflated = "\x78\x01\x01"s + char(size & 255) + char(size >> 8) +
                               char(~size & 255) + char(~size >> 8 & 255) + filtered +
                               big_endian(b << 16 | a);
  return "\x89PNG\r\n\x1a\n"s +
         png_chunk("IHDR" + big_endian(width) + big_endian(1) + depth + colour_type + "\0\0\0"s) +
         more_chunks + png_chunk("IDAT" + deflated) + png_chunk("IEND");
}

class ImageFile : public testing::Test {
 protected:
  LoadedImage load(const std::string& bytes) const {
    return read_gray_image(folder_.write("image", bytes));
  }
  std::string conversion(const std::string& bytes) const { return load(bytes).conversion; }
  std::string complaint(const std::string& bytes) const {
    try {
      load(bytes);
    } catch (const Error& error) {
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(ImageFile, GreyImagesAreReadAsTheyAreInEachFormat) {
  for (const char* format : kFormats) {
    const LoadedImage loaded = load(encoded(format, test_image()));
    EXPECT_EQ(loaded.conversion, "") << format;
    ASSERT_EQ(loaded.image.pixels.size(), test_image().size());
    const double tolerance = format == ".jpg"s ? 12.0 : 0.0;
    EXPECT_LE(cv::norm(loaded.image.pixels, test_image(), cv::NORM_INF), tolerance) << format;
  }
}

TEST_F(ImageFile, SixteenBitIsScaledToEightAndSaid) {
  cv::Mat deep;
  test_image().convertTo(deep, CV_16U, 257.0);
  for (const char* format : {".png", ".pgm", ".tiff"}) {
    const LoadedImage loaded = load(encoded(format, deep));
    EXPECT_EQ(loaded.conversion, "16 bit, scaled to 8");
    EXPECT_EQ(cv::norm(loaded.image.pixels, test_image(), cv::NORM_INF), 0.0) << format;
  }
}

TEST_F(ImageFile, OnlyTheBitsOfSixteenThatAnImageNeedsAreScaled) {
  const std::pair<int, int> largest_and_bits[] = {{255, 8},   {256, 10},   {1023, 10}, {1024, 12},
                                                  {4095, 12}, {16383, 14}, {16384, 16}};
  for (const auto& [largest, bits] : largest_and_bits) {
    cv::Mat1w deep(1, 2, static_cast<std::uint16_t>(largest));
    deep(0, 1) = static_cast<std::uint16_t>(largest / 2);
    const LoadedImage loaded = load(encoded(".png", deep));
    EXPECT_EQ(loaded.image.pixels(0, 0), std::lround(255.0 * largest / ((1 << bits) - 1)));
    EXPECT_EQ(loaded.image.pixels(0, 1), std::lround(255.0 * (largest / 2) / ((1 << bits) - 1)));
    EXPECT_THAT(loaded.conversion, StartsWith(bits == 16 ? "16 bit, scaled" : "16 bit of which"));
  }
}

TEST_F(ImageFile, BothImagesOfAPairAndThoseAfterItAreScaledAlike) {
  const auto file = [&](const char* name, int gray) {
    write_png(folder_.path() / name, cv::Mat1w(1, 1, static_cast<std::uint16_t>(gray)));
    return folder_.path() / name;
  };
  const auto dark = file("dark.png", 800), bright = file("bright.png", 4095);
  int used_bits = 0;
  const LoadedPair dark_left = read_gray_pair(dark, bright, used_bits);
  EXPECT_EQ(dark_left.left.image.pixels(0, 0), 50);
  EXPECT_EQ(dark_left.right.image.pixels(0, 0), 255);
  EXPECT_EQ(used_bits, 12);
  EXPECT_EQ(read_gray_pair(dark, dark, used_bits).right.image.pixels(0, 0), 50);
}

TEST_F(ImageFile, ColourAndAlphaAreTurnedToGreyAndSaid) {
  const cv::Mat colour(4, 4, CV_8UC3, cv::Scalar(255, 0, 0));
  const LoadedImage blue = load(encoded(".png", colour));
  EXPECT_EQ(blue.conversion, "colour, turned to grey");
  EXPECT_EQ(blue.image.pixels(0, 0), 29);  // 0.114 * 255
  const cv::Mat transparent(4, 4, CV_8UC4, cv::Scalar(90, 90, 90, 0));
  EXPECT_EQ(conversion(encoded(".png", transparent)), "colour, turned to grey; alpha left out");
  EXPECT_EQ(load(encoded(".png", transparent)).image.pixels(0, 0), 90);
  EXPECT_EQ(conversion(encoded(".jpg", colour)), "colour, turned to grey");
  const cv::Mat deep(4, 4, CV_16UC3, cv::Scalar(65535, 65535, 65535));
  EXPECT_EQ(conversion(encoded(".png", deep)), "16 bit, scaled to 8; colour, turned to grey");
  EXPECT_EQ(load(encoded(".png", deep)).image.pixels(0, 0), 255);
}

TEST_F(ImageFile, PalettesGreyWithAlphaAndFewBitsAreAccepted) {
  const std::string palette = png_chunk("PLTE\x0a\x0a\x0a\xc8\xc8\xc8");
  const LoadedImage indexed = load(png_of_one_row(4, 8, 3, "\0\1\1\0"s, palette));
  EXPECT_EQ(indexed.conversion, "palette, turned to grey");
  EXPECT_EQ(indexed.image.pixels(0, 0), 10);
  EXPECT_EQ(indexed.image.pixels(0, 1), 200);
  const LoadedImage alpha = load(png_of_one_row(2, 8, 4, "\x32\xff\x64\x00"s));
  EXPECT_EQ(alpha.conversion, "alpha left out");
  EXPECT_EQ(alpha.image.pixels(0, 1), 100);
  const LoadedImage four_bit = load(png_of_one_row(2, 4, 0, "\x0f"));
  EXPECT_EQ(four_bit.image.pixels(0, 0), 0);
  EXPECT_EQ(four_bit.image.pixels(0, 1), 255);
}

TEST_F(ImageFile, PgmIsScaledByItsLargestValue) {
  const LoadedImage ten_bit = load("P5\n# made by hand\n2 1\n1023\n\x03\xff\x00\x00"s);
  EXPECT_EQ(ten_bit.conversion, "16 bit, scaled to 8");
  EXPECT_EQ(ten_bit.image.pixels(0, 0), 255);
  EXPECT_EQ(ten_bit.image.pixels(0, 1), 0);
  const LoadedImage coarse = load("P5 2 1 100\n\x64\x32"s);
  EXPECT_EQ(coarse.conversion, "less than 8 bit, scaled to 8");
  EXPECT_EQ(coarse.image.pixels(0, 0), 255);
  const LoadedImage text = load("P2\n3 1\n255\n0 7 255\n");
  EXPECT_EQ(text.image.pixels(0, 1), 7);
}

TEST_F(ImageFile, CutOffImagesAreRefusedWithTheirSize) {
  for (const char* format : kFormats) {
    const std::string bytes = encoded(format, test_image());
    for (const std::size_t kept : {bytes.size() / 2, bytes.size() - 1, std::size_t{9}})
      EXPECT_EQ(complaint(bytes.substr(0, kept)),
                "image: is cut off (" + std::to_string(kept) + " bytes)")
          << format;
  }
}

TEST_F(ImageFile, EveryCutOfAnImageIsNoticed) {
  for (const char* format : kFormats) {
    const std::string bytes = encoded(format, test_image());
    for (std::size_t kept = 0; kept < bytes.size(); ++kept)
      EXPECT_THROW(inspect_image(bytes.substr(0, kept), "image"), Error) << format << " " << kept;
    EXPECT_EQ(inspect_image(bytes, "image").width, 24);
    EXPECT_EQ(inspect_image(bytes, "image").height, 16);
  }
}

TEST_F(ImageFile, ATiffWithItsTableBeforeItsPixelsMustHoldThemAll) {
  const auto entry = [](char tag_low, char tag_high, char value) {
    return std::string{tag_low, tag_high, 3, 0, 1, 0, 0, 0, value, 0, 0, 0};
  };
  const std::string table = "\4\0"s + entry(0, 1, 4) + entry(1, 1, 2) +  // 4 x 2 pixels in a strip
                            entry(0x11, 1, 62) + entry(0x17, 1, 8) + "\0\0\0\0"s;
  const std::string bytes = "II*\0\10\0\0\0"s + table + "12345678";
  EXPECT_EQ(inspect_image(bytes, "image").width, 4);
  EXPECT_THROW(inspect_image(bytes.substr(0, bytes.size() - 1), "image"), Error);
}

TEST_F(ImageFile, ThumbnailsAndRubbishAfterTheEndDoNotConfuseTheJpegEnd) {
  const std::string bytes = encoded(".jpg", test_image());
  const std::string thumbnail =
      "\xff\xe1\x00\x06\xff\xd8\xff\xd9"s;  // a segment with an end marker
  const std::string with_thumbnail = bytes.substr(0, 2) + thumbnail + bytes.substr(2);
  EXPECT_EQ(complaint(with_thumbnail), "");
  EXPECT_EQ(complaint(with_thumbnail + std::string(100, '\0')), "");
  EXPECT_THAT(complaint(with_thumbnail.substr(0, with_thumbnail.size() / 2)), HasSubstr("cut off"));
  cv::Mat noise(64, 64, CV_8U);
  cv::randu(noise, 0, 255);
  EXPECT_EQ(complaint(encoded(".jpg", noise, {cv::IMWRITE_JPEG_PROGRESSIVE, 1})), "");
  EXPECT_EQ(complaint(encoded(".jpg", noise, {cv::IMWRITE_JPEG_RST_INTERVAL, 2})), "");
}

TEST_F(ImageFile, OtherFilesAreRefused) {
  EXPECT_EQ(complaint(""), "image: is empty");
  EXPECT_EQ(complaint("hello"), "image: is not a PNG, PGM, JPEG, BMP or TIFF image");
  EXPECT_EQ(complaint("P5 0 4 255\n"), "image: has a side of 0 pixels");
  EXPECT_EQ(complaint("P5 4 x 255\n"), "image: is damaged (no number at byte 5)");
  EXPECT_EQ(complaint("P5 1 1 70000\n12"),
            "image: has a largest value of 70000, it must be 1 to 65535");
  EXPECT_THROW(read_gray_image(folder_.path() / "none.png"), Error);
  EXPECT_THROW(read_gray_image(folder_.path()), Error);
}

TEST_F(ImageFile, HugeSizesAreRefusedBeforeAnythingIsAllocated) {
  std::string bytes = "\x89PNG\r\n\x1a\n"s +
                      png_chunk("IHDR" + big_endian(30000) + big_endian(30000) + "\x08\0\0\0\0"s) +
                      png_chunk("IDAT") + png_chunk("IEND");
  EXPECT_EQ(complaint(bytes), "image: size is 30000 x 30000, at most 64 megapixels are read");
  EXPECT_EQ(complaint("P2 30000 30000 255\n1 2 3"),
            "image: size is 30000 x 30000, at most 64 megapixels are read");
  EXPECT_THAT(complaint("P5 99999999999999999999 1 255\n"), HasSubstr("has a side of"));
}

TEST_F(ImageFile, ABitFlipInAPngIsFound) {
  const std::string bytes = encoded(".png", test_image());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    EXPECT_THROW(inspect_image(flipped, "image"), Error) << at;
  }
}

TEST_F(ImageFile, DamagedImagesAreRefusedOrReadButNeverCrash) {
  std::mt19937 random(7);
  for (const char* format : {".pgm", ".bmp", ".tiff"}) {
    const std::string bytes = encoded(format, test_image());
    for (int i = 0; i < 300; ++i) {
      std::string mutant = bytes;
      for (int flips = 0; flips < 3; ++flips)
        mutant[random() % std::min<std::size_t>(mutant.size(), 200)] = static_cast<char>(random());
      const std::string said = [&] {
        try {
          inspect_image(mutant, "image");
          return std::string();
        } catch (const Error& error) {
          return std::string(error.what());
        }
      }();
      EXPECT_TRUE(said.empty() || said.starts_with("image: ")) << said;
    }
  }
}

TEST_F(ImageFile, PixelsAsStoredAndSizeAreReadToo) {
  const fs::path path = folder_.path() / "a.png";
  write_png(path, cv::Mat(3, 5, CV_16UC1, cv::Scalar(1000)));
  EXPECT_EQ(read_image_size(path), cv::Size(5, 3));
  const cv::Mat stored = read_image(path);
  ASSERT_EQ(stored.type(), CV_16UC1);
  EXPECT_EQ(stored.at<std::uint16_t>(2, 4), 1000);
}

TEST_F(ImageFile, NamesOfImagesAreKnownByTheirEnding) {
  for (const char* name : {"a.png", "a.PGM", "a.b.jpeg", "a.JPG", "a.bmp", "a.tif", "a.Tiff"})
    EXPECT_TRUE(has_image_name(name)) << name;
  for (const char* name : {"a", "a.txt", "png", ".png", "a.png.bak"})
    EXPECT_FALSE(has_image_name(name)) << name;
}

}  // namespace
}  // namespace stereovox
