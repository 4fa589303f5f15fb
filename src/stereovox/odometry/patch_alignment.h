// Finds where exactly a small piece of one image lies in another, to a fraction of a pixel
// (Lucas, Kanade 1981, in the inverse compositional form of Baker, Matthews 2004). Brightness and
// contrast may differ. The piece may be seen from elsewhere: an affine map shapes it first.
#pragma once

#include <Eigen/Core>
#include <optional>

#include <opencv2/core/mat.hpp>

namespace stereovox {

inline constexpr int kPatchRadius_px = 4;
inline constexpr int kPatchSide_px = 2 * kPatchRadius_px + 1;
inline constexpr int kPatchArea = kPatchSide_px * kPatchSide_px;

// The pixels of a patch row by row, then zeros up to a multiple of what fits in a register.
using Patch = Eigen::Array<float, (kPatchArea + 3) / 4 * 4, 1>;

// How the piece looks: brightness and its gradient, each with zero mean over the patch.
struct PatchTemplate {
  Patch value, gradient_u, gradient_v;
  float length;  // of `value` as a vector
};

// The piece around `center_px` of an image; `source_from_patch` maps offsets in the patch to
// offsets in the image. Nothing when it leaves the image or has no contrast.
std::optional<PatchTemplate> cut_patch(const cv::Mat1b& image, const Eigen::Vector2d& center_px,
                                       const Eigen::Matrix2d& source_from_patch);

struct Alignment {
  Eigen::Vector2d pixel;
  double score;  // zero-mean normalised correlation with the template
};

enum class AlignmentFreedom { both_axes, along_row };

// Moves the patch from `start_px` to where it fits best, at most `max_shift_px` away. Nothing when
// it leaves the image, moves farther or does not come to rest.
std::optional<Alignment> align_patch(const PatchTemplate& patch, const cv::Mat1b& image,
                                     const Eigen::Vector2d& start_px, AlignmentFreedom freedom,
                                     double max_shift_px);

}  // namespace stereovox
