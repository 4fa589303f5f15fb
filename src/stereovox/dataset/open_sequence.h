// From a folder to a stereo sequence. To add a layout, write <name>_layout.{h,cpp} and name it in
// the table of open_sequence.cpp.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "stereovox/dataset/stereo_sequence.h"

namespace stereovox {

// Finds out the layout by looking. `calibration` (the plain calib.yaml form) replaces the data
// set's own. Throws Error "<path>: ..." when the folder matches no layout, holds no pairs, or its
// calibration cannot be used; UsageError when the parameters leave no pair.
std::unique_ptr<StereoSequence> open_sequence(
    const std::filesystem::path& source, const SequenceParams& params = {},
    const std::optional<std::filesystem::path>& calibration = std::nullopt);

}  // namespace stereovox
