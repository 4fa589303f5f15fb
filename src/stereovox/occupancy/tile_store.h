// Room on disk for the parts of a map that are out of view: byte strings written, read back and
// released. The file has no name, so whatever ends the process, the system takes its space back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace stereovox {

struct StoredPlace {
  std::uint64_t offset = 0;
  std::uint32_t bytes = 0;
};

// Not for several threads at once.
class TileStore {
 public:
  // Opens a nameless file in the folder, which must exist; errors call it `what`. Throws
  // ResourceError.
  explicit TileStore(const std::filesystem::path& folder, const std::string& what = "tile store");
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;
  ~TileStore();

  // Throws ResourceError with the system's reason, for example a full disk; nothing is then stored.
  StoredPlace write(std::string_view bytes);
  // Throws ResourceError when the bytes cannot be read.
  std::string read(const StoredPlace& place) const;
  // The place may be used again.
  void release(const StoredPlace& place);

  // Text for errors about what was read.
  const std::string& name() const { return name_; }
  std::uint64_t bytes_in_use() const { return bytes_in_use_; }
  std::uint64_t file_bytes() const { return end_; }

 private:
  std::string name_;
  int descriptor_;
  std::uint64_t end_ = 0, bytes_in_use_ = 0;
  std::map<std::uint64_t, std::vector<std::uint64_t>> free_;  // offsets by size
};

}  // namespace stereovox
