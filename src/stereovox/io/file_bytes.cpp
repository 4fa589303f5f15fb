#include "stereovox/io/file_bytes.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// Asked before opening: opening a pipe would wait for a writer.
std::uint64_t size_of_regular_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw Error(path.string() + ": is a folder, not a file");
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(path.string() + ": is not a regular file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw Error(fmt::format("{}: cannot be opened ({})", path.string(), error.message()));
  return size;
}

}  // namespace

std::string read_file(const fs::path& path, std::uint64_t max_bytes) {
  const std::uint64_t size = size_of_regular_file(path);
  if (size > max_bytes)
    throw Error(
        fmt::format("{}: is {} bytes long, at most {} are read", path.string(), size, max_bytes));
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(fmt::format("{}: cannot be opened ({})", path.string(),
                            std::generic_category().message(errno)));
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) throw Error(fmt::format("{}: cannot be read to its end", path.string()));
  return bytes;
}

}  // namespace stereovox
