#include "stereovox/io/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class AtomicFile : public testing::Test {
 protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  fs::path path_ = folder_ / "map.svx";
};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

void write_text(const fs::path& path, const std::string& text) {
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

// What writing a text too large for `path` says.
std::string complaint_about(const fs::path& path, const std::string& text) {
  try {
    write_text(path, text);
  } catch (const ResourceError& error) {
    return error.what();
  }
  return "";
}

TEST_F(AtomicFile, HoldsExactlyWhatWasWrittenAndLeavesNothingBeside) {
  const std::string large(300000, 'x');
  write_text(path_, "old");
  write_text(path_, large + '\0' + "\r\n");
  EXPECT_EQ(content(path_), large + '\0' + "\r\n");
  EXPECT_EQ(files_in(folder_), 1);
}

TEST_F(AtomicFile, IsNotSeenBeforeItIsComplete) {
  write_text(path_, "old");
  write_file_atomically(path_, [&](std::ostream& out) {
    out << "new" << std::flush;
    EXPECT_EQ(content(path_), "old");
  });
  EXPECT_EQ(content(path_), "new");
}

TEST_F(AtomicFile, KeepsTheOldFileWhenTheWriterThrows) {
  write_text(path_, "old");
  const auto broken = [](std::ostream& out) {
    out << "half";
    throw Error("no more");
  };
  EXPECT_THROW(write_file_atomically(path_, broken), Error);
  EXPECT_EQ(content(path_), "old");
  EXPECT_EQ(files_in(folder_), 1);
}

TEST_F(AtomicFile, KeepsTheOldFileWhenTheFileGrowsTooLarge) {
  write_text(path_, "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{100000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string complaint = complaint_about(path_, std::string(200000, 'x'));
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(complaint, path_.string() + ": cannot be written (File too large)");
  EXPECT_EQ(content(path_), "old");
  EXPECT_EQ(files_in(folder_), 1);
}

TEST_F(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const fs::path disk = folder_ / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0)
    GTEST_SKIP() << "a small file system cannot be mounted here";
  write_text(disk / "map.svx", "old");
  const std::string complaint = complaint_about(disk / "map.svx", std::string(1 << 20, 'x'));
  const std::string kept = content(disk / "map.svx");
  const std::ptrdiff_t files = files_in(disk);
  umount(disk.c_str());
  EXPECT_THAT(complaint, HasSubstr("map.svx: cannot be written (No space left on device)"));
  EXPECT_EQ(kept, "old");
  EXPECT_EQ(files, 1);
}

TEST_F(AtomicFile, SaysWhyAFolderCannotBeWritten) {
  EXPECT_EQ(complaint_about(folder_ / "none" / "a", "x"),
            (folder_ / "none" / "a").string() + ": cannot be written (No such file or directory)");
  EXPECT_EQ(complaint_about(folder_, "x"),
            folder_.string() + ": cannot be written (Is a directory)");

  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                               fs::perms::others_exec);
  const uid_t user = geteuid(), nobody = 65534;
  const bool is_other_user = user != 0 || seteuid(nobody) == 0;
  const std::string complaint = complaint_about(path_, "x");
  ASSERT_EQ(user == 0 ? seteuid(user) : 0, 0);
  fs::permissions(folder_, fs::perms::owner_all);
  if (!is_other_user) GTEST_SKIP() << "root may write everywhere";
  EXPECT_EQ(complaint, path_.string() + ": cannot be written (Permission denied)");
}

TEST_F(AtomicFile, NeverReplacesAPipeOrDeviceAndFollowsALink) {
  const fs::path pipe = folder_ / "pipe";  // stands for /dev/null, which no test may endanger
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(complaint_about(pipe, "x"), pipe.string() + ": is not a regular file");
  EXPECT_TRUE(fs::is_fifo(pipe));
  write_text(path_, "old");
  fs::create_symlink("map.svx", folder_ / "link");
  write_text(folder_ / "link", "new");
  EXPECT_EQ(content(path_), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
}

}  // namespace
}  // namespace stereovox
