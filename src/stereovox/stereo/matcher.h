// Dense matching: a rectified pair in, a disparity for every left pixel that has one out.
//
// To add a matcher, write <name>.h with a params struct and an overload of `match`, and name the
// struct in MatcherParams; nothing else has to know it.
#pragma once

#include <variant>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/adaptive_window.h"
#include "stereovox/stereo/block_matching.h"
#include "stereovox/stereo/census_sgm.h"
#include "stereovox/stereo/semi_global_matching.h"

namespace stereovox {

// The first one is the default.
using MatcherParams = std::variant<CensusSgmParams, AdaptiveWindowParams, SemiGlobalMatchingParams,
                                   BlockMatchingParams>;

// The disparity image has the size of the left image. Disparities lie in
// [min_disparity_px, min_disparity_px + disparity_range_px) and are > 0; 0 means none: no match, an
// ambiguous one, one that fails the left-right check, an island smaller than speckle_size_px, or a
// pixel that one of the cameras did not record. sigma_px is > 0 where the disparity is, and so is
// the confidence of matchers that give one. The result is the same for any number of threads;
// OpenCV's matchers take the number that is set in OpenCV.
DisparityImage match(const RectifiedPair& pair, const MatcherParams& params, int threads = 1);

}  // namespace stereovox
