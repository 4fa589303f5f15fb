#include "stereovox/pipeline/disparity_store.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "stereovox/core/error.h"
#include "stereovox/occupancy/compression.h"

namespace stereovox {
namespace {

constexpr float kSigmaSteps = 256.0F;  // a pixel
constexpr float kMaxSteps = 65535.0F;
constexpr std::size_t kDisparityBytes = sizeof(std::uint32_t), kSigmaBytes = sizeof(std::uint16_t);

std::uint32_t bits_of_disparity(float disparity_px) {
  return std::bit_cast<std::uint32_t>(disparity_px);
}
std::uint16_t steps_of_sigma(float sigma_px) {
  return static_cast<std::uint16_t>(std::clamp(std::ceil(sigma_px * kSigmaSteps), 0.0F, kMaxSteps));
}

// The first bytes of all values, then the second ones, ...: like beside like is compressed well.
template <class Value>
void write_planes(const std::vector<Value>& values, char* bytes) {
  for (std::size_t byte = 0; byte < sizeof(Value); ++byte)
    for (const Value value : values) *bytes++ = static_cast<char>(value >> (8 * byte) & 0xff);
}

template <class Value>
std::vector<Value> read_planes(const char* bytes, std::size_t count) {
  std::vector<Value> values(count, 0);
  for (std::size_t byte = 0; byte < sizeof(Value); ++byte)
    for (Value& value : values)
      value = static_cast<Value>(value | Value{static_cast<unsigned char>(*bytes++)} << (8 * byte));
  return values;
}

}  // namespace

void DisparityStore::push_back(const DisparityImage& image) {
  const std::size_t count = image.disparity_px.total();
  std::vector<std::uint32_t> disparities(count);
  std::vector<std::uint16_t> sigmas(count);
  std::ranges::transform(image.disparity_px, disparities.begin(), bits_of_disparity);
  std::ranges::transform(image.sigma_px, sigmas.begin(), steps_of_sigma);
  std::string bytes(count * (kDisparityBytes + kSigmaBytes), '\0');
  write_planes(disparities, bytes.data());
  write_planes(sigmas, bytes.data() + count * kDisparityBytes);
  images_.push_back({store_.write(compressed(bytes)), image.disparity_px.size()});
}

DisparityImage DisparityStore::read(std::size_t index) const {
  const StoredImage& stored = images_[index];
  const auto count = static_cast<std::size_t>(stored.size.area());
  std::string bytes;
  try {
    bytes = decompressed(store_.read(stored.place), count * (kDisparityBytes + kSigmaBytes));
  } catch (const std::runtime_error& error) {
    throw ResourceError(store_.name() + ": " + error.what());
  }
  const auto disparities = read_planes<std::uint32_t>(bytes.data(), count);
  const auto sigmas = read_planes<std::uint16_t>(bytes.data() + count * kDisparityBytes, count);
  DisparityImage image{cv::Mat1f(stored.size), cv::Mat1f(stored.size)};
  std::ranges::transform(disparities, image.disparity_px.begin(),
                         [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
  std::ranges::transform(sigmas, image.sigma_px.begin(), [](std::uint16_t steps) {
    return static_cast<float>(steps) / kSigmaSteps;
  });
  return image;
}

}  // namespace stereovox
