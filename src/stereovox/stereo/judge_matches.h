// From the winners of a census matcher to disparities: sub-pixel positions, the features of their
// confidence, and what is rejected.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "stereovox/core/frame.h"
#include "stereovox/core/image.h"
#include "stereovox/stereo/census_search.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/match_confidence.h"

namespace stereovox {

MatchFeatures features_of_size(cv::Size size);

// Turns the winners of a row of images of this width into its features; keeps memory from row to
// row. The sub-pixel position is the vertex of the parabola through the local costs of the winner
// and its neighbours.
class FeatureRows {
 public:
  FeatureRows(int width_px, int min_disparity_px, int max_disparity_px);
  void fill(const WinnerRow& winners, int v, MatchFeatures& features);

 private:
  void find_owners(const WinnerRow& winners, const std::int16_t* disparity);

  // The owner of the right pixel of candidate 0 of pixel 0.
  std::uint32_t* first_owner() { return owner_.data() + before_ - max_disparity_px_; }

  const int width_px_, max_disparity_px_;
  const int before_, after_;          // right pixels beyond the image that candidates may reach
  std::vector<std::uint32_t> owner_;  // see OwnedRow
};

// Disparities that pass the checks of `search`, join two recorded pixels and are > 0, with the
// confidence and sigma of `model`.
DisparityImage judge_matches(const RectifiedPair& pair, const MatchFeatures& features,
                             const CensusSearch& search, const ConfidenceModel& model, int threads);

}  // namespace stereovox
