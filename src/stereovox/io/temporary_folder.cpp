#include "stereovox/io/temporary_folder.h"

#include <cstdlib>
#include <fstream>
#include <system_error>

#include "stereovox/core/error.h"

namespace stereovox {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  // The blank and the umlaut keep every user of paths honest.
  std::string name = (fs::temp_directory_path() / "stereovox ü XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw ResourceError(name + ": cannot be made");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const fs::path& name, std::string_view content) const {
  const fs::path path = path_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!file.flush()) throw ResourceError(path.string() + ": cannot be written");
  return path;
}

}  // namespace stereovox
