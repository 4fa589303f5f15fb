#include "stereovox/io/file_kind.h"

#include <array>
#include <fstream>
#include <string_view>

namespace stereovox {
namespace {

using namespace std::string_view_literals;

struct Kind {
  std::string_view first_bytes;
  const char* name;
};

constexpr std::array kKinds = {Kind{"#ROSBAG"sv, "a ROS 1 bag"},
                               Kind{"\x89MCAP"sv, "an MCAP file"},
                               Kind{"SQLite format 3"sv, "an SQLite file, of a ROS 2 bag perhaps"},
                               Kind{"\x89PNG"sv, "an image"},
                               Kind{"\xff\xd8\xff"sv, "an image"},
                               Kind{"P5\n"sv, "an image"},
                               Kind{"P6\n"sv, "an image"},
                               Kind{"ply\n"sv, "a point cloud"},
                               Kind{"# .PCD"sv, "a point cloud"},
                               Kind{"# Octomap"sv, "an OctoMap tree"}};

}  // namespace

std::string kind_of_file(const std::filesystem::path& path) {
  constexpr std::size_t kLongest = 16;
  std::string first(kLongest, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(first.data(), kLongest);
  for (const Kind& kind : kKinds)
    if (first.starts_with(kind.first_bytes)) return kind.name;
  return "";
}

}  // namespace stereovox
