// What a file is that was given in the place of another one.
#pragma once

#include <filesystem>
#include <string>

namespace stereovox {

// "a ROS 1 bag", "an MCAP file", "an image", ... by its first bytes; empty for text and for what is
// not known, and for what cannot be read.
std::string kind_of_file(const std::filesystem::path& path);

}  // namespace stereovox
