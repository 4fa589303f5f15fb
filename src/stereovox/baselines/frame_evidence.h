// The beams of one frame that cross a cell are one observation of it, not many: ten beams near the
// robot would otherwise count as ten independent readings (method.md C.0).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stereovox {

// Log-odds evidence of one frame: per cell the largest for occupied if any beam gives some, else
// the strongest for free.
class FrameEvidence {
 public:
  explicit FrameEvidence(std::size_t cells) : log_odds_(cells, 0.0), is_touched_(cells, 0) {}

  void add(std::size_t position, double log_odds) {
    double& fused = log_odds_[position];
    fused = std::max(fused, log_odds) > 0.0 ? std::max(fused, log_odds)   // also the first one,
                                            : std::min(fused, log_odds);  // because it meets 0
    if (!is_touched_[position]) touched_.push_back(position);
    is_touched_[position] = 1;
  }

  // Calls apply(position, log_odds) for each touched cell in the order of first touch, and begins
  // the next frame.
  template <class Apply>
  void hand_over(const Apply& apply) {
    for (const std::size_t position : touched_) {
      apply(position, log_odds_[position]);
      log_odds_[position] = 0.0;
      is_touched_[position] = 0;
    }
    touched_.clear();
  }

 private:
  std::vector<double> log_odds_;
  std::vector<unsigned char> is_touched_;
  std::vector<std::size_t> touched_;
};

}  // namespace stereovox
