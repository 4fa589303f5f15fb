#include "stereovox/odometry/patch_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereovox {
namespace {

constexpr int kMaxPatchIterations = 12;
// Finer steps are far below what the noise of the image allows.
constexpr double kAtRest_px = 0.005;
// Sum of squared brightness of a patch without contrast: one grey level per pixel.
constexpr float kMinLength = static_cast<float>(kPatchSide_px);
// Below this share of the largest curvature the patch can slide along an edge.
constexpr double kMinCurvatureRatio = 1e-3;

// Brightness between the pixels; the four pixels around must exist.
float interpolated(const cv::Mat1b& image, double u, double v) {
  const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
  const float a = static_cast<float>(u - u0), b = static_cast<float>(v - v0);
  const std::uint8_t *row = image[v0] + u0, *next = image[v0 + 1] + u0;
  const float above = row[0] + a * static_cast<float>(row[1] - row[0]);
  const float below = next[0] + a * static_cast<float>(next[1] - next[0]);
  return above + b * (below - above);
}

bool has_room(const cv::Mat1b& image, const Eigen::Vector2d& center_px, double reach_px) {
  return center_px.x() >= reach_px && center_px.y() >= reach_px &&
         center_px.x() + reach_px < image.cols - 1 && center_px.y() + reach_px < image.rows - 1;
}

void subtract_mean(Patch& patch) { patch.head<kPatchArea>() -= patch.sum() / kPatchArea; }

float dot(const Patch& a, const Patch& b) { return (a * b).sum(); }

// The patch at a sub-pixel place: the four weights are the same for all its pixels.
Patch sample(const cv::Mat1b& image, const Eigen::Vector2d& center_px) {
  const double left = center_px.x() - kPatchRadius_px, top = center_px.y() - kPatchRadius_px;
  const int u0 = static_cast<int>(left), v0 = static_cast<int>(top);
  const float a = static_cast<float>(left - u0), b = static_cast<float>(top - v0);
  const float w00 = (1 - a) * (1 - b), w01 = a * (1 - b), w10 = (1 - a) * b, w11 = a * b;
  Patch patch = Patch::Zero();
  int i = 0;
  for (int y = 0; y < kPatchSide_px; ++y) {
    const std::uint8_t *row = image[v0 + y] + u0, *next = image[v0 + y + 1] + u0;
    for (int x = 0; x < kPatchSide_px; ++x)
      patch[i++] = w00 * row[x] + w01 * row[x + 1] + w10 * next[x] + w11 * next[x + 1];
  }
  return patch;
}

// Gauss-Newton step of the patch, from the curvature of the template.
class Stepper {
 public:
  Stepper(const PatchTemplate& patch, AlignmentFreedom freedom) : patch_(patch) {
    uu_ = dot(patch.gradient_u, patch.gradient_u);
    if (freedom == AlignmentFreedom::along_row) return;
    uv_ = dot(patch.gradient_u, patch.gradient_v);
    vv_ = dot(patch.gradient_v, patch.gradient_v);
    moves_rows_ = true;
  }

  bool is_determined() const {
    if (!moves_rows_) return uu_ > 0.0;
    const double trace = uu_ + vv_;
    return uu_ * vv_ - uv_ * uv_ > kMinCurvatureRatio * trace * trace;
  }

  Eigen::Vector2d step(const Patch& difference) const {
    const double u = dot(patch_.gradient_u, difference);
    if (!moves_rows_) return {u / uu_, 0.0};
    const double v = dot(patch_.gradient_v, difference);
    const double determinant = uu_ * vv_ - uv_ * uv_;
    return {(vv_ * u - uv_ * v) / determinant, (uu_ * v - uv_ * u) / determinant};
  }

 private:
  const PatchTemplate& patch_;
  double uu_ = 0.0, uv_ = 0.0, vv_ = 0.0;
  bool moves_rows_ = false;
};

}  // namespace

std::optional<PatchTemplate> cut_patch(const cv::Mat1b& image, const Eigen::Vector2d& center_px,
                                       const Eigen::Matrix2d& source_from_patch) {
  constexpr int r = kPatchRadius_px + 1, side = 2 * r + 1;
  const double reach_px = source_from_patch.cwiseAbs().rowwise().sum().maxCoeff() * r + 1.0;
  if (!has_room(image, center_px, reach_px)) return std::nullopt;
  std::array<float, side * side> bordered;
  for (int y = -r; y <= r; ++y)
    for (int x = -r; x <= r; ++x) {
      const Eigen::Vector2d p = center_px + source_from_patch * Eigen::Vector2d(x, y);
      const int place = (y + r) * side + x + r;
      bordered[static_cast<std::size_t>(place)] = interpolated(image, p.x(), p.y());
    }

  PatchTemplate patch{Patch::Zero(), Patch::Zero(), Patch::Zero(), 0.0F};
  int i = 0;
  for (int y = 1; y + 1 < side; ++y)
    for (int x = 1; x + 1 < side; ++x, ++i) {
      const float* const at = bordered.data() + y * side + x;
      patch.value[i] = at[0];
      patch.gradient_u[i] = 0.5F * (at[1] - at[-1]);
      patch.gradient_v[i] = 0.5F * (at[side] - at[-side]);
    }
  for (Patch* values : {&patch.value, &patch.gradient_u, &patch.gradient_v}) subtract_mean(*values);
  patch.length = std::sqrt(dot(patch.value, patch.value));
  if (patch.length < kMinLength) return std::nullopt;
  return patch;
}

std::optional<Alignment> align_patch(const PatchTemplate& patch, const cv::Mat1b& image,
                                     const Eigen::Vector2d& start_px, AlignmentFreedom freedom,
                                     double max_shift_px) {
  const Stepper stepper(patch, freedom);
  if (!stepper.is_determined()) return std::nullopt;
  Eigen::Vector2d pixel = start_px;
  for (int iteration = 0; iteration < kMaxPatchIterations; ++iteration) {
    if (!has_room(image, pixel, kPatchRadius_px + 1)) return std::nullopt;
    Patch seen = sample(image, pixel);
    subtract_mean(seen);
    const float length = std::max(kMinLength, std::sqrt(dot(seen, seen)));
    const double score = dot(seen, patch.value) / (length * patch.length);
    const float gain = patch.length / length;
    seen = gain * seen - patch.value;
    const Eigen::Vector2d step = stepper.step(seen);
    if (step.norm() < kAtRest_px) return Alignment{pixel, score};
    pixel -= step;
    if (!((pixel - start_px).norm() <= max_shift_px)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace stereovox
