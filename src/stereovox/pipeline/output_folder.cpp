#include "stereovox/pipeline/output_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

// The first ones say that a folder holds results.
constexpr std::array kResults = {
    "map.svx", "nav.yaml",       "report.json", "nav.pgm",
    "nav.png", "trajectory.tum", "config.yaml", "trajectory_kitti.txt"};
constexpr std::size_t kTelling = 3;
constexpr std::string_view kSegmentPrefix = "segment_";

std::string text_of(int error_number) { return std::generic_category().message(error_number); }

const fs::path& made(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw ResourceError(folder.string() + ": is a file, not a folder");
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  return folder;
}

std::vector<fs::path> segments_in(const fs::path& folder) {
  std::vector<fs::path> segments;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || !name.starts_with(kSegmentPrefix)) continue;
    const std::string_view number = std::string_view(name).substr(kSegmentPrefix.size());
    if (number.find_first_not_of("0123456789") == std::string_view::npos && !number.empty())
      segments.push_back(entry.path());
  }
  return segments;
}

// Moves what is there, and removes what has no successor.
void replace_results(const fs::path& from, const fs::path& to) {
  for (const char* name : kResults)
    if (fs::exists(from / name))
      fs::rename(from / name, to / name);
    else
      fs::remove(to / name);
}

void replace_all(const fs::path& from, const fs::path& to) {
  replace_results(from, to);
  for (const fs::path& earlier : segments_in(to)) {
    for (const char* name : kResults) fs::remove(earlier / name);
    if (fs::is_empty(earlier)) fs::remove(earlier);
  }
  for (const fs::path& further : segments_in(from)) {
    fs::create_directory(to / further.filename());
    replace_results(further, to / further.filename());
  }
}

void check_writable(const fs::path& folder) {
  const fs::path probe = folder / ".stereovox_probe";
  std::ofstream file(probe);
  file << "probe" << std::flush;
  const int reason = errno;
  const bool is_good = file.good();
  file.close();
  std::error_code ignored;
  fs::remove(probe, ignored);
  if (!is_good)
    throw ResourceError(
        fmt::format("{}: cannot be written to: {}", folder.string(), text_of(reason)));
}

// The process that has locked an open file, as the system lists it: "1: FLOCK ADVISORY WRITE 4711
// 08:01:1234 0 EOF", with the file's number after the last colon.
std::string holder_of(int descriptor) {
  struct stat file {};
  if (fstat(descriptor, &file) != 0) return "?";
  const std::string number = fmt::format(":{}", file.st_ino);
  std::ifstream locks("/proc/locks");
  std::string line, skipped, process, place;
  while (std::getline(locks, line)) {
    std::istringstream words(line);
    words >> skipped >> skipped >> skipped >> skipped >> process >> place;
    if (place.ends_with(number)) return process;
  }
  return "?";
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder)
    : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ < 0)
    throw ResourceError(fmt::format("{}: cannot be opened: {}", folder.string(), text_of(errno)));
  if (::flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  const std::string holder = holder_of(folder_);
  ::close(folder_);
  throw ResourceError(
      fmt::format("{}: process {} is writing its results there", folder.string(), holder));
}

FolderLock::~FolderLock() { ::close(folder_); }

OutputFolder::OutputFolder(fs::path folder, bool overwrite)
    : folder_(std::move(folder)), staging_(folder_ / ".stereovox_new"), lock_(made(folder_)) {
  if (!overwrite && holds_results())
    throw UsageError(folder_.string() +
                     ": holds the results of a run; give --overwrite to replace them");
  check_writable(folder_);
  std::error_code ignored;
  fs::remove_all(staging_, ignored);  // of a run that was killed
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

bool OutputFolder::holds_results() const {
  std::error_code ignored;
  for (std::size_t i = 0; i < kTelling; ++i)
    if (fs::exists(folder_ / kResults[i], ignored)) return true;
  return false;
}

std::vector<std::string> OutputFolder::results() const {
  std::vector<std::string> names;
  for (const char* name : kResults)
    if (fs::exists(folder_ / name)) names.emplace_back(name);
  return names;
}

void OutputFolder::publish() {
  try {
    replace_all(staging_, folder_);
  } catch (const fs::filesystem_error& error) {
    throw ResourceError(
        fmt::format("{}: cannot be replaced: {}", folder_.string(), error.code().message()));
  }
}

}  // namespace stereovox
