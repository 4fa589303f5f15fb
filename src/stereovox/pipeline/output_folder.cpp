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
constexpr const char* kSegmentPrefix = "segment_";

std::string text_of(int error_number) { return std::generic_category().message(error_number); }

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw ResourceError(folder.string() + ": is a file, not a folder");
  fs::create_directories(folder, error);
  if (error)
    throw ResourceError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

std::vector<fs::path> segments_in(const fs::path& folder) {
  std::vector<fs::path> segments;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    const bool has_number =
        name.find_first_not_of("0123456789", std::char_traits<char>::length(kSegmentPrefix)) ==
        std::string::npos;
    if (entry.is_directory() && name.starts_with(kSegmentPrefix) && has_number)
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

OutputFolder::OutputFolder(fs::path folder, bool overwrite)
    : folder_(std::move(folder)), staging_(folder_ / ".stereovox_new") {
  make_folder(folder_);
  if (!overwrite && holds_results())
    throw UsageError(folder_.string() +
                     ": holds the results of a run; give --overwrite to replace them");
  check_writable(folder_);
  lock();
  std::error_code ignored;
  fs::remove_all(staging_, ignored);  // of a run that was killed
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  ::close(lock_);
}

bool OutputFolder::holds_results() const {
  std::error_code ignored;
  for (std::size_t i = 0; i < kTelling; ++i)
    if (fs::exists(folder_ / kResults[i], ignored)) return true;
  return false;
}

void OutputFolder::publish() {
  try {
    replace_all(staging_, folder_);
  } catch (const fs::filesystem_error& error) {
    throw ResourceError(
        fmt::format("{}: cannot be replaced: {}", folder_.string(), error.code().message()));
  }
}

// The folder itself is locked, so a killed run leaves nothing. Where that is not possible, there is
// no lock.
void OutputFolder::lock() {
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0)
    throw ResourceError(fmt::format("{}: cannot be opened: {}", folder_.string(), text_of(errno)));
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  const std::string holder = holder_of(lock_);
  ::close(lock_);
  throw ResourceError(
      fmt::format("{}: process {} is writing its results there", folder_.string(), holder));
}

}  // namespace stereovox
