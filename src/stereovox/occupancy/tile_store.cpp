#include "stereovox/occupancy/tile_store.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// Places have whole pages, so that a tile that grew a little finds one that was left.
constexpr std::uint64_t kPageBytes = 4096;

std::uint64_t room_for(std::uint32_t bytes) {
  return (bytes + kPageBytes - 1) / kPageBytes * kPageBytes;
}

[[noreturn]] void fail(const std::string& name, const char* what, int error_number) {
  throw ResourceError(
      fmt::format("{}: {} ({})", name, what, std::generic_category().message(error_number)));
}

// Where the system knows no files without a name, one that loses its name at once.
int open_nameless(const fs::path& folder) {
#ifdef O_TMPFILE
  if (const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); file >= 0)
    return file;
#endif
  std::string path = (folder / ".stereovox_tiles_XXXXXX").string();
  const int file = ::mkstemp(path.data());
  if (file >= 0) ::unlink(path.c_str());
  return file;
}

}  // namespace

TileStore::TileStore(const fs::path& folder, const std::string& what)
    : name_(what + " in " + folder.string()), descriptor_(open_nameless(folder)) {
  if (descriptor_ < 0) fail(name_, "cannot be made", errno);
}

TileStore::~TileStore() { ::close(descriptor_); }

StoredPlace TileStore::write(std::string_view bytes) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  std::vector<std::uint64_t>& reusable = free_[room_for(size)];
  const std::uint64_t offset = reusable.empty() ? end_ : reusable.back();
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                                     static_cast<off_t>(offset + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(name_, "cannot be written", written < 0 ? errno : EIO);
    done += static_cast<std::size_t>(written);
  }
  if (reusable.empty())
    end_ += room_for(size);
  else
    reusable.pop_back();
  bytes_in_use_ += room_for(size);
  return {offset, size};
}

std::string TileStore::read(const StoredPlace& place) const {
  std::string bytes(place.bytes, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                  static_cast<off_t>(place.offset + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(name_, "cannot be read", count < 0 ? errno : EIO);
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

void TileStore::release(const StoredPlace& place) {
  free_[room_for(place.bytes)].push_back(place.offset);
  bytes_in_use_ -= room_for(place.bytes);
}

}  // namespace stereovox
