// Decoding images while the caller works on earlier ones.
#pragma once

#include <memory>

#include "stereovox/dataset/stereo_sequence.h"

namespace stereovox {

// Delivers the same frames, skipped pairs, remarks and errors in the same order; a thread of its
// own reads up to `capacity` (at least 1) frames ahead. The result may be destroyed at any time.
std::unique_ptr<StereoSequence> read_ahead(std::unique_ptr<StereoSequence> sequence, int capacity);

}  // namespace stereovox
