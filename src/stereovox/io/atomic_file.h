// Writing a file so that a reader, a full disk or a power cut never meets half of it.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

namespace stereovox {

// Writes `<path>.tmp.<process id>` by calling `write`, syncs it, renames it to `path` and syncs the
// folder. When anything fails (also when `write` throws), the temporary file is removed, whatever
// stood at `path` is untouched, and ResourceError names the path and the system's reason. The
// stream is binary. A symbolic link at `path` is followed.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(std::ostream&)>& write);
void write_text_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace stereovox
