// A stereo sequence of image files, whatever their layout.
#pragma once

#include <memory>

#include "stereovox/dataset/listing.h"

namespace stereovox {

// `listing` as its layout found it, `rig` validated. Throws UsageError when the parameters leave no
// pair, and Error when the first images all have another size than the rig says.
std::unique_ptr<StereoSequence> make_folder_sequence(SequenceListing listing, const StereoRig& rig,
                                                     const SequenceParams& params);

}  // namespace stereovox
