// Worlds in YAML. docs/simulation.md describes the form; data/worlds/ holds examples.
#pragma once

#include <filesystem>
#include <string>

#include "stereovox/simulation/world.h"

namespace stereovox {

// Throws Error "<path>:<line>: ..." for unknown words, missing or impossible values.
World read_world(const std::filesystem::path& path);

// The same from text; `source` is named in errors.
World parse_world(std::string text, const std::string& source);

}  // namespace stereovox
