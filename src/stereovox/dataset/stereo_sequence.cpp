#include "stereovox/dataset/stereo_sequence.h"

namespace stereovox {

StereoSequence::~StereoSequence() = default;

void SequenceParams::describe(ParameterList& list) {
  list("start_s", start_s, {0, 1e9}, "begin so long after the first pair");
  list("duration_s", duration_s, {0, 1e9}, "end so long after the begin; 0 = at the last pair");
  list("max_frames", max_frames, {0, 1e9}, "deliver at most so many pairs; 0 = all");
  list("frame_skip", frame_skip, {0, 1e6}, "leave out so many pairs after each one that is used");
  list("max_skipped_percent", max_skipped_percent, {0, 100},
       "give up when a larger share of the pairs is unusable (a single one is always forgiven, "
       "except at 0)");
  list("max_stamp_difference_s", max_stamp_difference_s, {0, 1},
       "left and right images paired by time may differ by so much");
  list("assumed_rate_hz", assumed_rate_hz, {0.01, 1000},
       "pairs per second where the time stamps are missing or all the same");
}

}  // namespace stereovox
