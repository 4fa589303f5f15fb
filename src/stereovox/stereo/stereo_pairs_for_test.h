// The pairs with truth that tests read from ../shared/data/stereo_pairs, where it is there.
#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "stereovox/core/frame.h"

namespace stereovox {

struct PairWithTruth {
  RectifiedPair pair;
  cv::Mat1f truth_px;  // 0 = not known
};

inline std::filesystem::path folder_of_pair(const std::string& name) {
  return std::filesystem::path(STEREOVOX_SHARED_DIR) / "data/stereo_pairs" / name;
}

// Nothing when the pair is not there.
inline std::optional<PairWithTruth> read_pair_with_truth(const std::string& name) {
  constexpr double kTruthStep_px = 1.0 / 256.0;  // KITTI's form
  const std::filesystem::path folder = folder_of_pair(name);
  if (!std::filesystem::exists(folder)) return std::nullopt;
  PairWithTruth read;
  read.pair.left.pixels = cv::imread(folder / "left.png", cv::IMREAD_GRAYSCALE);
  read.pair.right.pixels = cv::imread(folder / "right.png", cv::IMREAD_GRAYSCALE);
  const cv::Mat truth = cv::imread(folder / "disp_gt.png", cv::IMREAD_ANYDEPTH);
  if (truth.type() != CV_16U)
    throw std::runtime_error((folder / "disp_gt.png").string() + " does not have 16 bits");
  truth.convertTo(read.truth_px, CV_32F, kTruthStep_px);
  return read;
}

}  // namespace stereovox
