#include "stereovox/navmap/write_map_server.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/io/temporary_folder.h"
#include "stereovox/io/yaml_file.h"
#include "stereovox/navmap/drawn_map_for_test.h"

namespace stereovox {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What the readers take from the YAML file, and one pixel after another from the lower left.
struct MapFile {
  double resolution = 0, occupied_thresh = 0, free_thresh = 0;
  std::vector<double> origin;
  int negate = 0;
  std::string mode;
  cv::Mat image;  // as stored, lower row first

  // Mean of the first `channels` channels.
  double mean(int i, int channels) const {
    double sum = 0;
    for (int c = 0; c < channels; ++c) sum += image.ptr<uchar>(i / image.cols)[pixel(i) + c];
    return sum / channels;
  }
  int alpha(int i) const {
    return image.channels() == 4 ? image.ptr<uchar>(i / image.cols)[pixel(i) + 3] : 255;
  }
  int pixel(int i) const { return i % image.cols * image.channels(); }
};

MapFile load(const std::filesystem::path& yaml_path) {
  const YAML::Node yaml = YAML::LoadFile(yaml_path.string());
  MapFile map;
  map.resolution = yaml["resolution"].as<double>();
  map.occupied_thresh = yaml["occupied_thresh"].as<double>();
  map.free_thresh = yaml["free_thresh"].as<double>();
  map.origin = yaml["origin"].as<std::vector<double>>();
  map.negate = yaml["negate"].as<int>();
  map.mode = yaml["mode"].as<std::string>();
  const auto image_path = yaml_path.parent_path() / yaml["image"].as<std::string>();
  cv::flip(cv::imread(image_path.string(), cv::IMREAD_UNCHANGED), map.image, 0);
  return map;
}

// The readers of the several versions: one cell as nav_msgs/OccupancyGrid.
// ROS 1 noetic: mean over all channels in trinary mode (alpha too), greater / less.
int ros1_cell(const MapFile& map, int i) {
  const int channels = map.image.channels();
  const bool only_colours = map.mode != "trinary" && channels > 1;
  double grey = map.mean(i, only_colours ? channels - 1 : channels);
  if (map.negate != 0) grey = 255 - grey;
  if (map.mode == "raw") return static_cast<signed char>(grey);
  const double occ = (255 - grey) / 255.0;
  if (occ > map.occupied_thresh) return 100;
  if (occ < map.free_thresh) return 0;
  if (map.mode == "trinary" || map.alpha(i) < 1) return -1;
  return static_cast<int>(1 +
                          98 * (occ - map.free_thresh) / (map.occupied_thresh - map.free_thresh));
}

// Nav2 Foxy, Galactic, Humble, Iron: transparency is asked after the thresholds.
int nav2_humble_cell(const MapFile& map, int i) {
  const bool averages_alpha = map.mode == "trinary" && map.image.channels() == 4;
  const double shade = map.mean(i, averages_alpha ? 4 : std::min(map.image.channels(), 3)) / 255.0;
  const double occ = map.negate != 0 ? shade : 1 - shade;
  if (map.mode == "raw") {
    const int value = static_cast<int>(std::lround(255 * shade));
    return value <= 100 ? value : -1;
  }
  if (map.mode == "scale" && map.alpha(i) < 255) return -1;
  if (map.occupied_thresh < occ) return 100;
  if (occ < map.free_thresh) return 0;
  if (map.mode == "trinary") return -1;
  return static_cast<int>(
      std::rint(100 * (occ - map.free_thresh) / (map.occupied_thresh - map.free_thresh)));
}

// Nav2 Jazzy, Kilted, main: thresholds belong to their class, transparent is unknown.
int nav2_jazzy_cell(const MapFile& map, int i) {
  const double grey = map.mean(i, std::min(map.image.channels(), 3));
  if (map.mode == "raw") {
    const int value = static_cast<signed char>(grey);
    return value >= 0 && value <= 100 ? value : -1;
  }
  if (map.alpha(i) < 255) return -1;
  const double occ = (map.negate != 0 ? grey : 255 - grey) / 255.0;
  if (occ >= map.occupied_thresh) return 100;
  if (occ <= map.free_thresh) return 0;
  if (map.mode == "trinary") return -1;
  return static_cast<int>(
      std::round(100 * (occ - map.free_thresh) / (map.occupied_thresh - map.free_thresh)));
}

// Nav2 main when the map came through its own saver, which keeps three decimals of the thresholds.
int nav2_resaved_cell(MapFile map, int i) {
  map.free_thresh = std::round(map.free_thresh * 1000) / 1000;
  map.occupied_thresh = std::round(map.occupied_thresh * 1000) / 1000;
  return nav2_jazzy_cell(map, i);
}

using Reader = std::function<int(const MapFile&, int)>;
const std::vector<std::pair<std::string, Reader>> kReaders = {{"ROS 1", ros1_cell},
                                                              {"Nav2 Humble", nav2_humble_cell},
                                                              {"Nav2 Jazzy", nav2_jazzy_cell},
                                                              {"Nav2 resaved", nav2_resaved_cell}};

Drawing drawing_by(const Reader& reader, const MapFile& map) {
  Drawing drawing;
  for (int y = map.image.rows - 1; y >= 0; --y) {
    std::string& line = drawing.emplace_back();
    for (int x = 0; x < map.image.cols; ++x) {
      const int value = reader(map, y * map.image.cols + x);
      line += value == -1 ? '?' : value == 100 ? '#' : '.';
    }
  }
  return drawing;
}

const Drawing kDrawing = {"##.?", "#..?", "??.."};

TEST(WriteMapServer, EveryReaderReadsTheLabelsThatWereWrittenInEveryMode) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "nav.yaml";
  for (const auto mode : {MapServerMode::trinary, MapServerMode::scale, MapServerMode::raw}) {
    write_map_server(path, drawn_grid(kDrawing), mode);
    const MapFile map = load(path);
    EXPECT_EQ(map.mode, names_of(mode)[static_cast<std::size_t>(mode)]);
    for (const auto& [name, reader] : kReaders)
      EXPECT_EQ(drawing_by(reader, map), kDrawing) << name << " " << map.mode;
  }
}

TEST(WriteMapServer, ResolutionAndOriginAreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  for (const double cell_size_m : {0.05, 0.0125, 0.025, 0.3, 0.1 / 3.0}) {
    const Eigen::Vector2d origin_m(-17 * cell_size_m, 1234 * cell_size_m);
    write_map_server(folder.path() / "nav.yaml", drawn_grid({"."}, cell_size_m, origin_m));
    const MapFile map = load(folder.path() / "nav.yaml");
    EXPECT_NEAR(map.resolution, cell_size_m, 1e-10);
    EXPECT_NEAR(map.origin[0], origin_m.x(), 1e-7);
    EXPECT_NEAR(map.origin[1], origin_m.y(), 1e-7);
    EXPECT_EQ(map.origin[2], 0.0);
  }
}

TEST(WriteMapServer, TheFilesAreTheseBytes) {
  const TemporaryFolder folder;
  write_map_server(folder.path() / "nav.yaml", drawn_grid({"#?", ".."}, 0.0125, {-0.5, 0.25}));
  EXPECT_EQ(content_of(folder.path() / "nav.yaml"),
            "image: nav.pgm\nmode: trinary\nresolution: 0.0125\norigin: [-0.5, 0.25, 0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(content_of(folder.path() / "nav.pgm"),
            std::string("P5\n2 2\n255\n\x00\xcd\xfe\xfe", 15));
}

TEST(WriteMapServer, ScaleGradesFreeCellsByTheirState) {
  const TemporaryFolder folder;
  OccupancyGrid2D grid = drawn_grid({"...#"});
  grid.states = {0.0F, 0.2F, 0.45F, 0.6F};
  write_map_server(folder.path() / "nav.yaml", grid, MapServerMode::scale);
  const MapFile map = load(folder.path() / "nav.yaml");
  for (const auto& [name, reader] : kReaders) {
    EXPECT_EQ(reader(map, 0), 0) << name;
    EXPECT_NEAR(reader(map, 1), 20, 1) << name;
    EXPECT_NEAR(reader(map, 2), 45, 1) << name;
    EXPECT_EQ(reader(map, 3), 100) << name;
  }
}

TEST(WriteMapServer, AnImageNameThatYamlWouldMisreadIsQuoted) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "floor: 1 #2.yaml";
  write_map_server(path, drawn_grid(kDrawing));
  EXPECT_EQ(drawing_by(ros1_cell, load(path)), kDrawing);
}

TEST(WriteMapServer, AFolderThatIsMissingIsAResourceError) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_map_server(folder.path() / "none" / "nav.yaml", drawn_grid(kDrawing)),
               ResourceError);
}

}  // namespace
}  // namespace stereovox
