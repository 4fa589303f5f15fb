#include "stereovox/io/disparity_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereovox/core/error.h"
#include "stereovox/io/image_file.h"
#include "stereovox/io/pfm.h"

namespace stereovox {
namespace {

constexpr float kStepsPerPixel = 256.0F;
constexpr float kMaxSteps = std::numeric_limits<std::uint16_t>::max();

cv::Mat1f read_kitti_png(const std::filesystem::path& path) {
  const cv::Mat stored = read_image(path);
  if (stored.type() != CV_16UC1)
    throw Error(fmt::format("{}: has {} channels of {} bit, a disparity PNG has 1 of 16",
                            path.string(), stored.channels(), 8 * stored.elemSize1()));
  cv::Mat1f disparity_px;
  stored.convertTo(disparity_px, CV_32F, 1.0 / kStepsPerPixel);
  return disparity_px;
}

cv::Mat1f read_disparity_pfm(const std::filesystem::path& path) {
  cv::Mat1f disparity_px = read_pfm(path);
  for (float& d : disparity_px)
    if (!std::isfinite(d) || d < 0.0F) d = 0.0F;
  return disparity_px;
}

void write_kitti_png(const std::filesystem::path& path, const cv::Mat1f& disparity_px) {
  cv::Mat_<std::uint16_t> steps(disparity_px.size());
  std::ranges::transform(disparity_px, steps.begin(), [&](float d) -> std::uint16_t {
    const float rounded = std::round(d * kStepsPerPixel);
    if (rounded > kMaxSteps)
      throw Error(fmt::format("{}: disparity {} px does not fit, the largest is {} px",
                              path.string(), d, kMaxSteps / kStepsPerPixel));
    return d > 0.0F ? static_cast<std::uint16_t>(std::max(rounded, 1.0F)) : 0;
  });
  write_png(path, steps);
}

[[noreturn]] void refuse_extension(const std::filesystem::path& path) {
  throw UsageError(fmt::format("{}: a disparity file ends with .pfm or .png", path.string()));
}

}  // namespace

DisparityImage read_disparity(const std::filesystem::path& path) {
  const std::filesystem::path extension = path.extension();
  if (extension != ".pfm" && extension != ".png") refuse_extension(path);
  const cv::Mat1f disparity_px =
      extension == ".pfm" ? read_disparity_pfm(path) : read_kitti_png(path);
  return {disparity_px, cv::Mat1f::zeros(disparity_px.size())};
}

void write_disparity(const std::filesystem::path& path, const DisparityImage& disparity) {
  const std::filesystem::path extension = path.extension();
  if (extension == ".pfm")
    write_pfm(path, disparity.disparity_px);
  else if (extension == ".png")
    write_kitti_png(path, disparity.disparity_px);
  else
    refuse_extension(path);
}

}  // namespace stereovox
