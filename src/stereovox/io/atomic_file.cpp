#include "stereovox/io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <streambuf>
#include <system_error>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr int kNewFileMode = 0666;  // less the user's umask

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error_number) {
  throw ResourceError(fmt::format("{}: {} ({})", path.string(), what,
                                  std::generic_category().message(error_number)));
}

// An open file as a stream buffer. A standard file stream forgets why a write failed; this one
// keeps the first error number.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) { reset(); }
  int error_number() const { return error_number_; }

 protected:
  int_type overflow(int_type c) override {
    if (!write_out()) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  int sync() override { return write_out() ? 0 : -1; }

 private:
  void reset() { setp(buffer_.data(), buffer_.data() + buffer_.size()); }

  bool write_out() {
    const char* from = pbase();
    while (from != pptr() && error_number_ == 0) {
      const ssize_t written = ::write(descriptor_, from, static_cast<std::size_t>(pptr() - from));
      if (written >= 0) from += written;
      if (written < 0 && errno != EINTR) error_number_ = errno;
    }
    reset();
    return error_number_ == 0;
  }

  int descriptor_;
  int error_number_ = 0;
  std::array<char, kBufferBytes> buffer_{};
};

// A file that disappears unless it was renamed to its final name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& final_path)
      : final_path_(final_path),
        path_(final_path.string() + fmt::format(".tmp.{}", ::getpid())),
        descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kNewFileMode)) {
    if (descriptor_ < 0) fail(final_path_, "cannot be written", errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!path_.empty()) ::unlink(path_.c_str());
  }

  void fill(const std::function<void(std::ostream&)>& write) {
    DescriptorBuffer buffer(descriptor_);
    std::ostream stream(&buffer);
    write(stream);
    stream.flush();
    if (!stream)
      fail(final_path_, "cannot be written", buffer.error_number() ? buffer.error_number() : EIO);
  }

  void rename_to_final() {
    if (::fsync(descriptor_) != 0) fail(final_path_, "cannot be synced", errno);
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail(final_path_, "cannot be closed", errno);
    if (::rename(path_.c_str(), final_path_.c_str()) != 0)
      fail(final_path_, "cannot be replaced", errno);
    path_.clear();
  }

 private:
  fs::path final_path_, path_;
  int descriptor_;
};

// Makes the rename itself durable. A file system that cannot sync a folder is not an error.
void sync_folder_of(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool disk_failed = ::fsync(descriptor) != 0 && errno == EIO;
  ::close(descriptor);
  if (disk_failed) fail(path, "its folder cannot be synced", EIO);
}

// The path to write. A device must not be replaced by a file of its name.
fs::path checked_target(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, "cannot be written", EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw ResourceError(path.string() + ": is not a regular file");
  return fs::is_symlink(fs::symlink_status(path, error)) ? fs::weakly_canonical(path, error) : path;
}

}  // namespace

void write_file_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  const fs::path target = checked_target(path);
  TemporaryFile file(target);
  file.fill(write);
  file.rename_to_final();
  sync_folder_of(target);
}

void write_text_atomically(const std::filesystem::path& path, const std::string& text) {
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace stereovox
