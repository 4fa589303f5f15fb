// The content of a file, bounded before it is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace stereovox {

// All bytes of a regular file. Throws Error "<path>: ..." when it is missing, a folder, a device,
// unreadable, or larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

}  // namespace stereovox
