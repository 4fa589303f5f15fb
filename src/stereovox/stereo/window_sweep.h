// Winner takes all on census costs summed over cross-shaped adaptive windows: from a pixel an arm
// reaches in each direction as far as the brightness stays alike, and the window of a pixel is made
// of the horizontal arms of all pixels on its vertical arms. After Zhang, Lu and Lafruit
// ("Cross-based local stereo matching using orthogonal integral images", CSVT 2009), with the arms
// of the left image alone: then a window is the same for all candidates.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "stereovox/stereo/census_rows.h"
#include "stereovox/stereo/census_sweep.h"
#include "stereovox/stereo/window_kernels.h"

namespace stereovox {

struct ArmParams {
  int max_arm_px = 17;  // up to kMaxArm_px
  int contrast_gray = 10;
};

// How far the arms of each pixel reach, within the image and at least 1 px where there is a pixel.
struct Arms {
  cv::Mat1b left, right, up, down;
  int max_arm_px = 0;
};
Arms arms_of(const cv::Mat1b& image, const ArmParams& params, const WindowKernels& kernels,
             int threads);

class WindowSweep {
 public:
  // Starts with `first_row`; the rows above it that its windows reach are gathered first. Refers to
  // `pair` and `arms`.
  WindowSweep(const CensusPair& pair, const Arms& arms, int min_disparity_px, int candidates,
              int first_row, const WindowKernels& kernels);

  void next_row(WinnerRow& found);  // `found` has the images' width

 private:
  void gather_until(int end_row);
  void gather_row();
  std::uint8_t* costs_of(int row);
  std::uint16_t* sums_above(int row);
  std::uint16_t* areas_above(int row);
  void find_areas();

  const Arms& arms_;
  const WindowKernels& kernels_;
  const std::size_t size_index_;  // of the kernels for this number of candidates
  const int width_px_, height_px_, candidates_;
  CensusRows pixels_;
  int y_, gathered_;  // the next row; the first row that is not gathered
  std::vector<std::uint16_t> along_, area_;
  // Sums of costs and of pixels over all rows above a row, for the rows between which a window
  // lies.
  std::vector<std::vector<std::uint16_t>> sums_, areas_;
  std::vector<std::vector<std::uint8_t>> costs_;  // of the same rows
};

// The same arms and winners of rows [first_row, end_row), plainly: the oracle of the tests.
Arms arms_reference(const cv::Mat1b& image, const ArmParams& params);
std::vector<WinnerRow> windows_reference(const RectifiedPair& pair, const Arms& arms,
                                         int min_disparity_px, int candidates, int first_row,
                                         int end_row);

}  // namespace stereovox
