// A folder of its own for each object, removed with all it holds when the object dies.
#pragma once

#include <filesystem>
#include <string_view>

namespace stereovox {

class TemporaryFolder {
 public:
  TemporaryFolder();  // throws ResourceError
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Writes `<folder>/<name>`, making the folders in between, and returns its path.
  std::filesystem::path write(const std::filesystem::path& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

}  // namespace stereovox
