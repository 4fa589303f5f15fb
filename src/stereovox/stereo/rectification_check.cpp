#include "stereovox/stereo/rectification_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr int kCorners = 150;
constexpr double kCornerQuality = 0.01;
// Of the image width: between corners, and how far to either side a match is sought.
constexpr double kCornerDistance_share = 0.025, kReach_share = 0.25;
constexpr int kPatchRadius_px = 7;
constexpr int kSearchRows_px = 8;
// Correlation that a true match reaches and that a chance match hardly does.
constexpr double kMinCorrelation = 0.9;
// The best match elsewhere must stay below this share of the best.
constexpr double kMaxRivalShare = 0.95;
// Far points have a disparity near zero, of which noise makes either sign.
constexpr double kClearDisparity_px = 1.0;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Offset of the vertex of the parabola through three values at -1, 0, 1.
double vertex_offset(double before, double at, double after) {
  const double curvature = before - 2.0 * at + after;
  return std::abs(curvature) < 1e-12 ? 0.0 : 0.5 * (before - after) / curvature;
}

double best_elsewhere(const cv::Mat1f& scores, cv::Point best) {
  const cv::Rect around(best.x - kPatchRadius_px, best.y - kPatchRadius_px, 2 * kPatchRadius_px + 1,
                        2 * kPatchRadius_px + 1);
  cv::Mat1f rest = scores.clone();
  rest(around & cv::Rect({}, rest.size())).setTo(-1.0F);
  double rival = 0.0;
  cv::minMaxLoc(rest, nullptr, &rival);
  return rival;
}

struct Offset {
  double vertical_px, disparity_px;
};

std::optional<Offset> find_again(const RectifiedPair& pair, cv::Point corner, int reach_px) {
  const cv::Rect image({}, pair.left.pixels.size());
  const int r = kPatchRadius_px;
  const cv::Rect patch(corner.x - r, corner.y - r, 2 * r + 1, 2 * r + 1);
  const cv::Rect strip = cv::Rect(patch.x - reach_px, patch.y - kSearchRows_px,
                                  patch.width + 2 * reach_px, patch.height + 2 * kSearchRows_px) &
                         image;
  if ((patch & image) != patch) return std::nullopt;

  cv::Mat1f scores;
  cv::matchTemplate(pair.right.pixels(strip), pair.left.pixels(patch), scores,
                    cv::TM_CCOEFF_NORMED);
  double score = 0.0;
  cv::Point best;
  cv::minMaxLoc(scores, nullptr, &score, nullptr, &best);
  const bool at_edge = best.y == 0 || best.y == scores.rows - 1;
  if (score < kMinCorrelation || at_edge) return std::nullopt;
  const double row = strip.y + best.y +
                     vertex_offset(scores(best.y - 1, best.x), score, scores(best.y + 1, best.x));
  const Offset offset{row - patch.y, static_cast<double>(patch.x - (strip.x + best.x))};
  if (best_elsewhere(scores, best) > kMaxRivalShare * score) return std::nullopt;
  return offset;
}

}  // namespace

CornerOffsets measure_corner_offsets(const RectifiedPair& pair) {
  std::vector<cv::Point2f> corners;
  const int width = pair.left.width();
  cv::goodFeaturesToTrack(pair.left.pixels, corners, kCorners, kCornerQuality,
                          width * kCornerDistance_share, pair.valid_left);
  CornerOffsets out;
  for (const cv::Point2f& corner : corners)
    if (const auto offset =
            find_again(pair, cv::Point(corner), static_cast<int>(width * kReach_share))) {
      out.vertical_px.push_back(offset->vertical_px);
      out.disparity_px.push_back(offset->disparity_px);
    }
  return out;
}

RectificationCheck summarize(const std::vector<CornerOffsets>& offsets) {
  std::vector<double> vertical_px;
  int clear = 0, negative = 0;
  for (const CornerOffsets& frame : offsets) {
    for (const double offset_px : frame.vertical_px) vertical_px.push_back(std::abs(offset_px));
    for (const double d : frame.disparity_px) {
      clear += std::abs(d) > kClearDisparity_px ? 1 : 0;
      negative += d < -kClearDisparity_px ? 1 : 0;
    }
  }
  RectificationCheck check;
  check.corners = static_cast<int>(vertical_px.size());
  if (check.corners > 0) check.vertical_px = median(std::move(vertical_px));
  if (clear > 0) check.negative_share = static_cast<double>(negative) / clear;
  return check;
}

std::string judge(const RectificationCheck& check, const RectificationParams& params,
                  const std::string& source) {
  if (check.looks_swapped())
    throw Error(
        fmt::format("{}: left and right images look swapped: {:.0f} % of {} matched corners "
                    "lie farther right in the right image",
                    source, 100.0 * check.negative_share, check.corners));
  if (!check.is_conclusive())
    return fmt::format("rectification could not be checked: only {} corners were matched",
                       check.corners);
  const double offset_px = check.vertical_px;
  if (offset_px >= params.refuse_offset_px)
    throw Error(
        fmt::format("{}: images are not rectified: matched corners differ by {:.2f} px vertically "
                    "(median of {}), "
                    "{} px or more is refused; does the calibration belong to these images?",
                    source, offset_px, check.corners, params.refuse_offset_px));
  if (offset_px > params.warn_offset_px)
    return fmt::format(
        "rectification is poor: matched corners differ by {:.2f} px vertically "
        "(median of {})",
        offset_px, check.corners);
  return "";
}

}  // namespace stereovox
