// "sim:WORLD.yaml[:DRIVE[:SEED]]" as a source of images.
#pragma once

#include <memory>
#include <string>

#include "stereovox/simulation/simulated_sequence.h"

namespace stereovox {

bool is_simulated_source(const std::string& source);

// Throws UsageError for a seed that is no number, Error for a world that cannot be used.
std::unique_ptr<StereoSequence> open_simulated_source(const std::string& source,
                                                      const SequenceParams& params, int threads);

// "main", or the only drive of the world when it has just one.
std::string default_drive(const World& world);

}  // namespace stereovox
